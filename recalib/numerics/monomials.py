"""The monomials of a point's coordinates: a polynomial is a weighted sum of them."""

from functools import cache

import numpy as np

from recalib.numerics.compiled import compiled


def monomials(points: np.ndarray, degree: int) -> np.ndarray:
    """The products (..., F) of up to `degree` coordinates of points (..., d), by their degrees."""
    shorter, last = factors(points.shape[-1], degree)
    products = _products(points.reshape(-1, points.shape[-1]), shorter, last)
    return products.reshape(*points.shape[:-1], len(last))


@cache
def factors(dimensions: int, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Of each monomial but the first, which is 1: the shorter one and the coordinate it is made of.

    Both are indices (F,), in the order of `monomials`.
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


@compiled
def _products(points: np.ndarray, shorter: np.ndarray, last: np.ndarray) -> np.ndarray:
    products = np.empty((len(points), len(shorter)))
    for row in range(len(points)):
        products[row, 0] = 1
        for index in range(1, len(shorter)):
            products[row, index] = products[row, shorter[index]] * points[row, last[index]]
    return products
