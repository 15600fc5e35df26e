"""The two errors of every measurement: one home of their columns, their units and their names."""

ERRORS = ("position_error_cm", "orientation_error_deg")
KINDS = ("position", "orientation")
UNITS = ("cm", "degrees")
