"""The monomials of a point's coordinates: a polynomial is a weighted sum of them."""

from functools import cache

import numpy as np


def monomials(points: np.ndarray, degree: int) -> np.ndarray:
    """The products (..., F) of up to `degree` coordinates of points (..., d), sorted by degree."""
    shorter, last = factors(points.shape[-1], degree)
    products = np.ones((*points.shape[:-1], len(last)))
    for _ in range(degree):  # each pass completes the monomials of one more degree
        products[..., 1:] = products[..., shorter[1:]] * points[..., last[1:]]
    return products


@cache
def factors(dimensions: int, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """The factors of each monomial: the monomial of one degree less, and the last coordinate.

    Both are indices (F,), in the order of `monomials`. Those of the first monomial, 1, are unused.
    """
    shorter, last, before = [0], [0], range(1)
    for _ in range(degree):
        longer = [
            (which, coordinate) for which in before for coordinate in range(last[which], dimensions)
        ]
        before = range(len(last), len(last) + len(longer))
        shorter += [which for which, _ in longer]
        last += [coordinate for _, coordinate in longer]
    return np.array(shorter), np.array(last)
