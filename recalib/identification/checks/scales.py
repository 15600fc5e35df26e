"""What measurements are worth: how large what measures an arm is, and how well the arm returns.

An arm whose links may have any length explains boards, distances and positions of any scale: all
grow together. So links are held as long as they are described where a scale is asked for, and only
joint offsets, frames, optics and scales are found.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from recalib.identification.estimation import identify
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.model.frames import HELD, Frames
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import BOARD, Optics
from recalib.nominal.kinematics import Arm

# Of displacements [m, rad], for a rad by which joints do not return.
COVARIANCE = np.diag([LEVER**2] * 3 + [1.0] * 3)
RETURNS = 3e-5, 1e-4, 3e-4, 1e-3  # rad: from what hardly an arm does better to a worn one
ANY = 0.5  # standard deviation of a scale that may be anything
LINKS = 2e-3  # rad, times a lever m: so far links that are held make an arm miss


def returning(model: ErrorModel, observations: Observations) -> np.ndarray:
    """The covariance (6, 6) [m, rad] by which the arm does not return to a posture.

    Corners determine some directions of a pose a hundred times better than others. If the arm
    itself does not return as well, the surest directions are less sure than they look. So each pose
    has the covariance of its corners and, in addition, this one, whose size is the most probable of
    a few.

    Raises BadMeasurement, as `identify`.
    """
    tried = []
    for size in RETURNS:
        covariance = size**2 * COVARIANCE
        weighed = observations.with_noise(covariance)
        assert weighed.optics is not None
        # a density of residuals before they were whitened
        volume = np.linalg.slogdet(weighed.optics.whitening).logabsdet.sum()
        evidence = identify(model, weighed).log_evidence
        tried.append((evidence + volume, -size, covariance))
    return max(tried, key=lambda one: one[:2])[2]


class Scale(NamedTuple):
    """The scale of something.

    Attributes:
        factor: the estimated size over the stated one.
        remaining: the noise with the estimated sizes over the noise with the stated ones, or with
            positions as in the table; 0 for a board, where it is not needed. If other links than
            those described are the reason, or none has a length, much of the noise remains.
    """

    factor: float
    remaining: float


def scales(arm: Arm, observations: Observations, frames: Frames) -> Sequence[Scale]:
    """The scale of each board, of each distance between sockets, or of all measured positions.

    Simulated arms determine the scale of a board to 0.3 percent. The frames are an initial
    estimate, with optics if cameras measured.

    Raises BadMeasurement, as `identify`.
    """
    each, by_cameras = len(BOARD), observations.optics is not None
    if by_cameras:
        observations = observations.with_noise(LINKS**2 * COVARIANCE)
    elif observations.measured is not None:
        observations, each = replace(observations, optics=_rod(observations)), 1
        frames = frames.with_optics(_rod(observations))
    model, sizes = ErrorModel(arm, OFFSETS, frames), frames.optics_kinds < len(BOARD)
    held = ~model.free
    held[model.offset_columns] = held[model.socket_columns] = False
    model.deviations[held] = HELD
    model.deviations[model.optics_columns][sizes] = HELD
    noise = np.inf if by_cameras else identify(model, observations).noise[0]
    model.deviations[model.optics_columns][sizes] = ANY
    found = identify(model, replace(observations, distances=()))
    centres = model.sockets(found.parameters)
    factors = [
        float(np.linalg.norm(centres[one] - centres[other])) / length
        for one, other, length, _ in observations.distances
    ]
    errors = found.parameters[model.optics_columns][sizes].reshape(-1, each).mean(axis=1)
    unit = 1.0
    if observations.measured is not None and not by_cameras:
        # where no link holds the size, all may shrink to a point, and its noise with it
        unit = max(abs(1 + errors.item()), HELD)
    remaining = float(found.noise[0] / noise / unit)
    return [Scale(factor, remaining) for factor in [*factors, *(1 + errors).tolist()]]


def _rod(observations: Observations) -> Optics:
    """Positions that were measured by a rod, whose length is all that there is of optics."""
    count, size = len(observations), 3 * observations.kinds
    slopes = np.zeros((count, size, 1))
    slopes[:, :3, 0] = observations.positions
    nothing, same = np.zeros((count, 1, 1)), np.tile(np.eye(size), (count, 1, 1))
    return Optics(same, slopes, nothing, nothing[..., 0], same, same, np.zeros(1, dtype=int))
