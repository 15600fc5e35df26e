"""Corrected commands one at a time, for the loop of a controller."""

import numpy as np

from recalib.laboratory.correction.archive import Correction
from recalib.laboratory.correction.correct import reach
from recalib.laboratory.tables.measurements import Measurements


class Corrector:
    """What takes the real arm to a pose, starting from the command before: `correct` in a loop.

    Args:
        correction: what `load_correction` returned.
    """

    def __init__(self, correction: Correction):
        self._correction = correction

    def command(self, pose: np.ndarray, near: np.ndarray, target: str | None = None) -> np.ndarray:
        """Joint coordinates (joints,) [rad, m] to send.

        Args:
            pose: (4, 4), or a position (3,) [m] where the rotation is free.
            near: (joints,) rad, m, a command close by, such as the last one: the solution stays on
                its branch.
            target: whose pose it is, in the instrument's frame; the tool link's, in the arm's base,
                unless given.

        Raises as `correct`: NotReached, InvalidSetting and UnknownName.
        """
        whole = pose.ndim == 2
        desired = Measurements(
            1,
            near[None],
            (pose[:3, 3] if whole else pose)[None],
            pose[None, :3, :3] if whole else None,
            targets=None if target is None else np.array([target]),
        )
        return reach(self._correction, desired, target is not None)[0]
