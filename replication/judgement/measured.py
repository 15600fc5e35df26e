"""The two errors of every measurement: one home of their columns, their units and their names."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

ERRORS = ("position_error_cm", "orientation_error_deg")
KINDS = ("position", "orientation")
UNITS = ("cm", "degrees")
BOTH = "both"  # errors of the same measurement
MOVED = "translation_rotation"  # the scenario of the whole robot moved, in both ways
RIGID = ("translation", "rotation", MOVED)
NONE = 1e-6  # cm and degrees: an initial error below it is rounding


def errors_of(history: "pd.DataFrame", moment: str = "last") -> np.ndarray:
    """Both errors (search, seed, 2) in a training's last or first measurement."""
    when = history["iteration"].max() if moment == "last" else history["iteration"].min()
    then = history[history["iteration"] == when].sort_values("seed")
    return then[list(ERRORS)].to_numpy().reshape(then["search"].nunique(), -1, len(ERRORS))
