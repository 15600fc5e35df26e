"""Readers of tables of measurements and of their descriptions."""
