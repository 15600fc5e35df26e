"""The Rerun viewer, and arms in it."""
