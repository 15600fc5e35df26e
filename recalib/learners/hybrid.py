"""Geometry, joint errors and a Gaussian process: as much of them as the measurements show."""

from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.model.error_model import JOINT_ERRORS, JOINT_WAVES, OFFSETS
from recalib.identification.model.observations import Observations
from recalib.learners.geometric import GeometricLearner
from recalib.nominal.kinematics import Arm


class HybridLearner(GeometricLearner):
    """A geometric learner with joint errors and a model of residuals; see `calibrate`.

    Such as eccentric gears and sag.
    """

    @staticmethod
    def _calibrate(arm: Arm, observations: Observations, last: Calibration | None) -> Calibration:
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)

    @classmethod
    def identify(cls, arm: Arm, observations: Observations) -> Calibration:
        """As for a geometric learner, with more kinds of joint errors."""
        return calibrate(arm, (OFFSETS, JOINT_ERRORS, JOINT_WAVES), observations)
