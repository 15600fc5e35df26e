"""The monomials of a point's coordinates: a polynomial is a weighted sum of them."""

from functools import cache

import numpy as np


def monomials(points: np.ndarray, degree: int) -> np.ndarray:
    """The products (..., F) of up to `degree` coordinates of points (..., d), by their degrees."""
    levels = [np.ones((*points.shape[:-1], 1))]
    for shorter, coordinates in _factors(points.shape[-1], degree):
        levels.append(levels[-1][..., shorter] * points[..., coordinates])
    return np.concatenate(levels, axis=-1)


@cache
def _factors(dimensions: int, degree: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each degree: which monomial of the degree below and which coordinate make each of its."""
    factors, last = [], np.zeros(1, int)
    for _ in range(degree):
        shorter = np.repeat(np.arange(len(last)), dimensions - last)
        last = np.concatenate([np.arange(first, dimensions) for first in last])
        factors.append((shorter, last))
    return factors
