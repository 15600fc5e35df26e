import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from recalib.learners import nearest, regular_grid


def test_the_grid_halves_the_boxes_it_cuts_or_reaches_the_faces():
    assert np.allclose(regular_grid([3]), [[-2 / 3], [0], [2 / 3]])
    assert np.allclose(regular_grid([2, 1]), [[-0.5, 0], [0.5, 0]])
    assert np.allclose(regular_grid([3], "faces"), [[-1], [0], [1]])
    assert np.allclose(regular_grid([2, 1], "faces"), [[-1, 0], [1, 0]])


@given(shape=st.tuples(*[st.integers(1, 4)] * 3), seed=st.integers(0, 100))
def test_the_nearest_centre_of_the_grid_is_the_box_that_holds_the_point(shape, seed):
    points = np.random.default_rng(seed).uniform(-1, 1, (50, 3))
    boxes = np.minimum((points + 1) / 2 * shape, np.subtract(shape, 1e-9)).astype(int)
    assert np.array_equal(
        nearest(points, regular_grid(shape)), np.ravel_multi_index(boxes.T, shape)
    )
