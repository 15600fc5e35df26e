"""The configuration of a study: its keys with meaning, unit and range, its reading and checking."""
