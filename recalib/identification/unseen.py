"""Directions of the geometry that the rows do not determine, although other postures would.

Examples are the length of a tool that is always upright, and the height of the base beneath it. A
bent arm determines them a little, but then a small misfit of another kind moves them by decimetres.
So the rows' information on them is discarded, and the prior alone decides: they stay at nominal.
"""

from dataclasses import replace

import numpy as np

from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.frames import HELD
from recalib.identification.model.linearisation import LEVER, Linearisation
from recalib.identification.model.observations import Observations
from recalib.numerics.randomness import generator

# m, rms: the motion of the target, for wear of one standard deviation, below which rows do not show
# a direction, and above which other postures do.
NOTHING, SOMETHING = 1e-4, 3e-3
UNKNOWN = 0.1  # fraction of an unknown frame's deviation that counts as wear
POSTURES = 40  # random, over the joints' ranges


class Unseen:
    """The directions of an error model that observations do not show, linearised at nominal.

    Attributes:
        directions: (P, k) of the frames, links and offsets, over the parameters' deviations.
    """

    def __init__(self, model: ErrorModel, observations: Observations):
        columns, size = geometry_of(model), len(model.deviations)
        wear = np.where(model.free[columns], UNKNOWN, 1.0)
        here = _slopes(model, observations)[:, columns] * wear
        values, vectors = np.linalg.eigh(here.T @ here / len(observations))
        unseen = vectors[:, values < NOTHING**2]
        there = _slopes(model, anywhere(model, observations, POSTURES))[:, columns] * wear @ unseen
        values, vectors = np.linalg.eigh(there.T @ there / POSTURES)
        unseen = unseen @ vectors[:, values > SOMETHING**2]
        self.directions, self._across = np.zeros((2, size, unseen.shape[1]))
        self.directions[columns] = unseen * wear[:, None]
        self._across[columns] = unseen / wear[:, None]

    def left_out(self, columns: np.ndarray) -> np.ndarray:
        """Slopes or gradients (..., P) without their components along these directions."""
        return columns - (columns @ self.directions) @ self._across.T


def geometry_of(model: ErrorModel) -> np.ndarray:
    """The indices of the parameters of frames, links and offsets that are not held."""
    numbers = np.arange(len(model.deviations))
    numbers = np.concatenate([numbers[: model.optics_columns.start], numbers[model.offset_columns]])
    return numbers[model.deviations[numbers] > HELD]


def _slopes(model: ErrorModel, observations: Observations) -> np.ndarray:
    """Slopes (m, P) [m] of all measured quantities by the parameters over their deviations."""
    origin = np.zeros(len(model.deviations))
    jacobians = Linearisation(model, origin, observations).jacobians
    levers = np.array([1, LEVER])[: observations.kinds, None, None, None]
    return (jacobians * levers).reshape(-1, len(origin))


def anywhere(model: ErrorModel, observations: Observations, count: int) -> Observations:
    """`count` observations of the same kind and all targets, at random over the joints' ranges."""
    arm, rng, rows = model.nominal.model, generator(0, "anywhere"), np.arange(count)
    low, high = np.clip([arm.lowerPositionLimit, arm.upperPositionLimit], -np.pi, np.pi)
    others = observations[rows % len(observations)]
    targets = rows % (int(observations.targets.max()) + 1)
    joints = rng.uniform(low, high, (count, len(low)))
    return replace(others, joints=joints, targets=targets, optics=None)
