"""The configuration of a study: its keys, their meaning, units, ranges and defaults, and how it is read and checked."""
