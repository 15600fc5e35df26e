from itertools import combinations_with_replacement

import numpy as np
import pytest

from recalib.numerics.monomials import monomials


@pytest.mark.parametrize(("dimensions", "degree"), [(1, 4), (3, 0), (6, 1), (6, 3)])
def test_every_product_is_there_once(dimensions, degree):
    points = np.random.default_rng(0).normal(size=(2, 5, dimensions))
    chosen = [
        which
        for length in range(degree + 1)
        for which in combinations_with_replacement(range(dimensions), length)
    ]
    expected = np.stack([points[..., which].prod(axis=-1) for which in map(list, chosen)], axis=-1)
    np.testing.assert_allclose(monomials(points, degree), expected)
