"""The two errors of every measurement: their columns, units and names."""

ERRORS = ("position_error_cm", "orientation_error_deg")
KINDS = ("position", "orientation")
UNITS = ("cm", "degrees")
BOTH = "both"  # errors of the same measurement
MOVED = "translation_rotation"  # the scenario of the whole robot moved, in both ways
RIGID = ("translation", "rotation", MOVED)
NONE = 1e-6  # cm and degrees: an initial error below it is rounding
