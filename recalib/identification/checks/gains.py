"""Wrong gains: joints that turn by more or less than their column, or also by another's column."""

from dataclasses import dataclass

import numpy as np

from recalib.identification.calibration import Calibration
from recalib.identification.checks.postures import find_postures
from recalib.identification.checks.sequence import SHARE, Candidate, Unexplained, slopes_of
from recalib.identification.model.error_model import JOINT_ERRORS
from recalib.identification.model.observations import Observations

LEAST, LEAST_GAIN = 0.01, 0.02  # of a joint's motion: the effects of gears and sag are less
FIRST_WAVE = [*JOINT_ERRORS].index("sine 1")


@dataclass(frozen=True)
class WrongGain:
    """A joint that turns by its column and, in addition, by a share of another joint's column.

    Attributes:
        joint, by: the numbers of both; equal if the joint's own gain is wrong.
        share: the fraction of the motion of joint `by`.
    """

    joint: int
    by: int
    share: float


def wrong_gain(geometry: Calibration, observations: Observations) -> WrongGain | None:
    """The wrong gain that explains the largest part of the residuals that no arm explains.

    None if chance or gears may explain them.

    Gains by a joint are compared without its waves, which look similar if the joint turned little.
    """
    slopes = slopes_of(geometry, observations, 1)
    model, nominal = slopes.model, geometry.model.nominal
    postures = find_postures(observations.joints, nominal.slides, geometry.estimate.noise[0])
    redundancy = len(observations) / len(postures)
    by_offset = slopes.arm[..., model.offset_columns] / model.deviations[model.offset_columns]
    moved = observations.joints - observations.joints.mean(axis=0)
    rows, accepted = np.arange(len(moved)), []
    complete = Unexplained(slopes.residuals, slopes.arm, redundancy)
    for by in np.flatnonzero(~postures.still):
        terms = model.offset_columns.start + len(moved[0]) * np.arange(len(model.names)) + by
        without = slopes.arm.copy()
        without[..., terms[FIRST_WAVE:]] = 0.0
        reduced = Unexplained(slopes.residuals, without, redundancy)
        for joint in np.flatnonzero(nominal.slides == nominal.slides[by]):
            columns = by_offset[..., [joint]] * moved[:, by, None, None]
            candidate = Candidate("", rows, columns)
            share, _, (found,) = reduced.strongest(candidate)
            least = LEAST_GAIN if joint == by else LEAST
            if share < SHARE or abs(found) < least:
                continue
            if joint == by or complete.strongest(candidate)[0] >= SHARE:
                accepted.append((share, WrongGain(int(joint), int(by), float(found))))
    return max(accepted, key=lambda one: one[0], default=(None, None))[1]
