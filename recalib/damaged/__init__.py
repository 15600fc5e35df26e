"""The damaged robot: what may be wrong with an arm, and what comes of a command to it."""
