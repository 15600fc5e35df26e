import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib.learners.nets import Nets, nearest, regular_grid


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


def test_the_neighbourhood_is_one_at_the_winner_and_falls_as_a_gaussian_in_each_net():
    nets = Nets((3, 3, 3), (3, 3, 3))
    k, l = np.array([13]), np.array([0])
    g_k, g_kl = nets.neighbourhood(k, l, np.array([0.5]), np.array([0.8]))
    assert g_k[0, 13] == g_k.max() == 1 and g_kl[0, 0] == g_kl.max() == 1
    d_k = np.linalg.norm(nets.w_k[26] - nets.w_k[13])
    d_kl = np.linalg.norm(nets.w_kl[5] - nets.w_kl[0])
    assert g_k[0, 26] == pytest.approx(np.exp(-(d_k**2) / (2 * 0.5**2)))
    assert g_kl[0, 5] == pytest.approx(np.exp(-(d_kl**2) / (2 * 0.8**2)))


def test_where_half_ranges_are_more_units_neighbourhoods_reach_less_far():
    k, l, width = np.array([13]), np.array([13]), np.array([0.5])
    plain, stretched = (
        Nets((3, 3, 3), (3, 3, 3), units=units).neighbourhood(k, l, width, width)
        for units in ((1.0,) * 6, (2, 1, 1, 1, 1, 0.5))
    )
    along_x, along_y, along_yaw = 13 + 9, 13 + 3, 13 + 1
    assert stretched[0][0, along_x] == pytest.approx(plain[0][0, along_x] ** 4)
    assert stretched[0][0, along_y] == plain[0][0, along_y]
    assert stretched[1][0, along_yaw] == pytest.approx(plain[1][0, along_yaw] ** 0.25)
