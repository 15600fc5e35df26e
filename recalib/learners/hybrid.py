"""Geometry, joint errors and a Gaussian process: as much of them as the measurements show."""

import numpy as np

from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.error_model import JOINT_ERRORS, OFFSETS
from recalib.identification.observations import Observations
from recalib.learners.geometric import GeometricLearner


class HybridLearner(GeometricLearner):
    """A geometric learner that also learns what no geometry explains; see `calibrate`.

    Such as eccentric gears and sag.
    """

    def _calibrate(
        self, angles: np.ndarray, measured: np.ndarray, last: Calibration | None
    ) -> Calibration:
        arm, observations = self._controller.robot.arm, Observations(angles, measured)
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)
