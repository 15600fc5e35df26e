"""A study of the paper: a function from one configuration to figures, tables and verdicts."""
