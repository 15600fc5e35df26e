"""The scale of measurements, such as that of a printed board, and the repeatability of the arm.

An arm whose links may have any length explains boards, distances and positions of any scale: all
grow together. So links are held at their described lengths while a scale is estimated, and only
joint offsets, frames, optics and scales are free.
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

# The covariance of displacements [m, rad], for a joint repeatability of one rad.
COVARIANCE = np.diag([LEVER**2] * 3 + [1.0] * 3)
RETURNS = 3e-5, 1e-4, 3e-4, 1e-3  # rad: joint repeatabilities, from an excellent to a worn arm
ANY = 0.5  # standard deviation of an unknown scale
LINKS = 2e-3  # rad (times a lever, m): the arm's errors because its links are held


def returning(model: ErrorModel, observations: Observations) -> np.ndarray:
    """The covariance (6, 6) [m, rad] of the arm's returns to a posture: its repeatability.

    Corners determine some directions of a pose a hundred times better than others. If the arm does
    not return as precisely, the best directions are less certain than they look. So each pose has
    the covariance of its corners plus this one, whose size is the most probable of a few.

    Raises BadMeasurement, as `identify`.
    """
    tried = []
    for size in RETURNS:
        covariance = size**2 * COVARIANCE
        weighed = observations.with_noise(covariance)
        assert weighed.optics is not None
        # from the density of whitened residuals to that of the residuals themselves
        volume = np.linalg.slogdet(weighed.optics.whitening).logabsdet.sum()
        evidence = identify(model, weighed).log_evidence
        tried.append((evidence + volume, -size, covariance))
    return max(tried, key=lambda one: one[:2])[2]


class Scale(NamedTuple):
    """The estimated scale of a board, of a distance, or of positions.

    Attributes:
        factor: the estimated size over the stated one.
        remaining: the noise with the estimated sizes over the noise with the stated ones, or with
            positions as in the table; 0 for a board, which does not need it. Much of the noise
            remains if links differ from their description, or if no link has a length.
    """

    factor: float
    remaining: float


def scales(arm: Arm, observations: Observations, frames: Frames) -> Sequence[Scale]:
    """The scale of each board, of each distance between sockets, or of all measured positions.

    In simulations, the scale of a board is accurate to 0.3 percent. The frames are an initial
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
        # if no link has a length, everything may shrink to a point, and the noise with it
        unit = max(abs(1 + errors.item()), HELD)
    remaining = float(found.noise[0] / noise / unit)
    return [Scale(factor, remaining) for factor in [*factors, *(1 + errors).tolist()]]


def _rod(observations: Observations) -> Optics:
    """Optics of positions that a rod measured: their only parameter is the length of the rod."""
    count, size = len(observations), 3 * observations.kinds
    slopes = np.zeros((count, size, 1))
    slopes[:, :3, 0] = observations.positions
    nothing, unit = np.zeros((count, 1, 1)), np.tile(np.eye(size), (count, 1, 1))
    return Optics(unit, slopes, nothing, nothing[..., 0], unit, unit, np.zeros(1, dtype=int))
