"""Geometry, joint errors and a Gaussian process: as much of them as the measurements show."""

from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.error_model import JOINT_ERRORS, OFFSETS
from recalib.identification.observations import Observations
from recalib.learners.geometric import GeometricLearner


class HybridLearner(GeometricLearner):
    """A geometric learner that also learns what no geometry explains; see `calibrate`.

    Such as eccentric gears and sag.
    """

    def _calibrate(self, observations: Observations, last: Calibration | None) -> Calibration:
        arm = self._controller.robot.arm
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)
