"""The most informative postures to measure next, and whether more are worthwhile.

Candidates come from the user, or are drawn from the measured range of joints and a little beyond.
In this range, the instrument saw the target and the arm hit nothing; joint limits ensure neither.
Postures near the ends of joint ranges are left out.
"""

from dataclasses import replace

import numpy as np

from recalib.errors import InvalidSetting, RecalibError
from recalib.identification.design import most_informative
from recalib.laboratory.correction import Correction
from recalib.laboratory.reaching import Goals, reach
from recalib.nominal.kinematics import Arm
from recalib.numerics.randomness import generator
from recalib.spelling import counted

DRAWN = 400  # candidates drawn at random
BEYOND = 0.1  # of the measured range, added at either end
OUTERMOST = 0.05  # of a joint's range, left out at either end, where joints behave differently
PROBES = 200  # postures at which the uncertainty is computed


def propose(
    correction: Correction, count: int, candidates: np.ndarray | Goals | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The most informative postures to measure, each chosen given those before it.

    Returns their joints (n, columns) [rad, or m for sliding joints], as the controller reports
    them, and the mean deviation (n + 1,) [m] of predicted positions before and after each.

    Args:
        count: number of postures.
        candidates: joint coordinates (n, columns), or poses of the tool in the arm's base (default:
            drawn at random). Those out of reach or near the end of a joint's range are left out.

    Raises InvalidSetting if a ball in sockets was measured and no candidates are given, and
    RecalibError if no candidate can be used.
    """
    if candidates is not None:
        postures = useful(correction, candidates)
    elif len(correction.calibration.frames.sockets):
        raise InvalidSetting("candidates", None, "postures in which the ball sits in a socket")
    else:
        postures = _drawn(correction)
    calibration, coupling = correction.calibration, correction.arm.coupling
    probes = coupling.joints(_drawn(correction)[:PROBES])

    def uncertainty(covariance: np.ndarray) -> float:
        """Mean deviation [m] of predicted positions, given the covariance of the parameters."""
        estimate = replace(calibration.estimate, covariance=covariance)
        spread = replace(calibration, estimate=estimate).position_covariances(probes, False)
        return float(np.sqrt(np.trace(spread, axis1=1, axis2=2)).mean())

    found = [*most_informative(calibration, coupling.joints(postures), count)]
    covariances = [calibration.estimate.covariance, *(covariance for _, covariance in found)]
    chosen = [best for best, _ in found]
    return postures[chosen], np.array([*map(uncertainty, covariances)])


def _drawn(correction: Correction) -> np.ndarray:
    low, high = correction.postures.min(axis=0), correction.postures.max(axis=0)
    margin = BEYOND * (high - low)
    lower, upper = joint_limits(correction.arm)
    low, high = (np.clip(end, lower, upper) for end in (low - margin, high + margin))
    return generator(0, "postures to measure next").uniform(low, high, (DRAWN, len(low)))


def joint_limits(arm: Arm) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper joint limits (columns,) [rad, m], without the outermost parts of ranges."""
    lower, upper = arm.coupling.limits
    margin = np.where(np.isfinite(upper - lower), OUTERMOST * (upper - lower), 0.0)
    return lower + margin, upper - margin


def useful(correction: Correction, candidates: np.ndarray | Goals) -> np.ndarray:
    """Joints (n, columns) of candidates within reach and away from the ends of joint ranges.

    Raises RecalibError if there are none.
    """
    if isinstance(candidates, Goals):
        found, _, reached = reach(correction.calibration, correction.postures, candidates)
    else:
        found, reached = candidates, np.ones(len(candidates), dtype=bool)
    lower, upper = joint_limits(correction.arm)
    useful = reached & ((found >= lower) & (found <= upper)).all(axis=1)
    if not reached.any():
        raise RecalibError(
            f"0 of {counted(len(candidates), 'candidate')} can be reached;"
            " are their poses in the arm's base?"
        )
    if not useful.any():
        raise RecalibError(
            f"{reached.sum()} of {counted(len(candidates), 'candidate')} can be reached, each with"
            " a joint near the end of its range; try: candidates with all joints away from it"
        )
    return found[useful]
