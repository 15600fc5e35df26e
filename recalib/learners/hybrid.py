"""Geometry, joint errors and a Gaussian process: as much of them as the measurements show."""

from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.model.error_model import JOINT_ERRORS, JOINT_WAVES, OFFSETS
from recalib.identification.model.observations import Observations
from recalib.learners.geometric import GeometricLearner
from recalib.nominal.kinematics import Arm


class HybridLearner(GeometricLearner):
    """A geometric learner that also learns what no geometry explains; see `calibrate`.

    Such as eccentric gears and sag.
    """

    @staticmethod
    def _calibrate(arm: Arm, observations: Observations, last: Calibration | None) -> Calibration:
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)

    @classmethod
    def identify(cls, arm: Arm, observations: Observations) -> Calibration:
        """As a geometric learner's; at once, there is time to look for more errors of joints."""
        return calibrate(arm, (OFFSETS, JOINT_ERRORS, JOINT_WAVES), observations)
