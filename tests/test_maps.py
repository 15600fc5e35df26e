import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib.learners.maps import (
    HierarchicalMap,
    nearest,
    propagate_increments,
    propagate_values,
    regular_grid,
)


def test_the_grid_halves_the_boxes_it_cuts():
    assert np.allclose(regular_grid([3]), [[-2 / 3], [0], [2 / 3]])
    assert np.allclose(regular_grid([2, 1]), [[-0.5, 0], [0.5, 0]])


@given(shape=st.tuples(*[st.integers(1, 4)] * 3), seed=st.integers(0, 100))
def test_the_nearest_centre_of_the_grid_is_the_box_that_holds_the_point(shape, seed):
    points = np.random.default_rng(seed).uniform(-1, 1, (50, 3))
    boxes = np.minimum((points + 1) / 2 * shape, np.subtract(shape, 1e-9)).astype(int)
    assert np.array_equal(
        nearest(points, regular_grid(shape)), np.ravel_multi_index(boxes.T, shape)
    )


@pytest.mark.parametrize("outputs", [slice(0, 6), slice(0, 3), slice(3, 6)])
@pytest.mark.parametrize("sizes", [((3, 3, 3), (3, 3, 3)), ((2, 1, 4), (1, 1, 2))])
def test_a_new_map_is_the_identity(sizes, outputs):
    fresh = HierarchicalMap(2, *sizes, outputs)
    u = np.random.default_rng(0).uniform(-1.5, 1.5, (2, 30, 6))
    assert np.allclose(fresh.output(u), u[..., outputs], atol=1e-14)


def test_the_neighbourhood_is_one_at_the_winner_and_falls_as_a_gaussian_in_each_net():
    net = HierarchicalMap(1, (3, 3, 3), (3, 3, 3))
    k, l = np.array([13]), np.array([0])
    g = net.neighbourhood(k, l, np.array([0.5]), np.array([0.8]))[0]
    assert g[13, 0] == 1 and g.max() == 1
    far_k, far_l = 26, 5
    d_k, d_kl = ((net.w_k[26] - net.w_k[13]) ** 2).sum(), ((net.w_kl[5] - net.w_kl[0]) ** 2).sum()
    assert g[far_k, far_l] == pytest.approx(
        np.exp(-d_k / (2 * 0.5**2)) * np.exp(-d_kl / (2 * 0.8**2))
    )


def test_values_draw_and_increments_shift():
    cells, weights = np.ones((1, 2, 3, 4)), np.full((1, 3, 4), 0.25)
    weights[0, 0] = 0
    propagate_values(cells, weights, np.array([[5.0, 9.0]]))
    assert (
        np.all(cells[0, :, 0] == 1)
        and np.all(cells[0, 0, 1:] == 2)
        and np.all(cells[0, 1, 1:] == 3)
    )
    propagate_increments(cells, weights, np.array([[4.0, -4.0]]))
    assert np.all(cells[0, :, 0] == 1) and np.all(cells[0, :, 1:] == [[[3]], [[2]]])


def test_the_same_thing_is_learned_alone_and_beside_others():
    rng = np.random.default_rng(1)
    cells, weights, values = (
        rng.normal(size=(4, 2, 3, 4)),
        rng.uniform(size=(4, 3, 4)),
        rng.normal(size=(4, 2)),
    )
    alone = cells[2:3].copy()
    propagate_values(cells, weights, values)
    propagate_values(alone, weights[2:3], values[2:3])
    assert np.array_equal(cells[2:3], alone)
