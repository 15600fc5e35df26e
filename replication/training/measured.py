"""The two errors of every measurement: their columns, units and names."""

ERRORS = ("position_error_cm", "orientation_error_deg")
KINDS = ("position", "orientation")
UNITS = ("cm", "degrees")
BOTH = "both"  # both errors in the same measurement
MOVED = "translation_rotation"  # scenario: the whole robot is translated and rotated
RIGID = ("translation", "rotation", MOVED)
NONE = 1e-6  # cm and degrees: smaller initial errors are rounding
