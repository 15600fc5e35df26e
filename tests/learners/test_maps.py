"""Updates that wait and are applied together are the updates that they would be one by one."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from recalib import Rules
from recalib.learners import JACOBIAN, THETA, WAITING, Maps, kernels

RUNS = 3


def at_once(held, increments, rate, g_k, g_kl, star):
    """One update of all cells (run, map, K, L, n): (4) and (5), or (7) and (9)."""
    weights = np.einsum("r,rmk,rml->rmkl", rate, g_k, g_kl)[..., None]
    star = star[:, :, None, None]
    return held + weights * (star if increments else star - held)


@given(
    separate=st.booleans(),
    increments=st.tuples(st.booleans(), st.booleans()),
    steps=st.lists(st.tuples(st.integers(0, WAITING), st.booleans()), max_size=6),
    seed=st.integers(0, 100),
)
def test_any_sequence_equals_immediate_updates(separate, increments, steps, seed):
    rng = np.random.default_rng(seed)
    maps = Maps(RUNS, Rules(separate, *increments, True, supernet=(2, 1, 2), subnet=(1, 3, 1)))
    cells = maps.cells
    theta, jacobian = cells.theta.copy(), cells.jacobian.copy()
    for updates, settles in steps:
        for _ in range(updates):
            if maps.waiting == WAITING:
                maps.settle()
            here = np.s_[:, :, maps.waiting]
            for array in (cells.g_k, cells.g_kl):
                array[here] = rng.uniform(size=array[here].shape)
            for array in (cells.theta_star, cells.jacobian_star):
                array[here] = rng.normal(size=array[here].shape)
            rates = rng.choice([0.0, 0.3, 1.0], (RUNS, 2))  # some learn nothing, some all
            cells.rates[:, maps.waiting] = rates
            near = cells.g_k[here], cells.g_kl[here]
            star = cells.theta_star[here]
            theta = at_once(theta, increments[THETA], rates[:, THETA], *near, star)
            star = cells.jacobian_star[here]
            jacobian = at_once(jacobian, increments[JACOBIAN], rates[:, JACOBIAN], *near, star)
            maps.waiting += 1
        desired = rng.uniform(-1, 1, (RUNS, 6))
        given = tuple(cells), maps.waiting, maps.increments, desired
        _, winners, held, slopes = kernels.respond(*given)
        for run, (k, l) in enumerate(winners):
            assert np.allclose(held[run], theta[run, :, k, l].ravel(), atol=1e-12)
            assert np.allclose(slopes[run].ravel(), jacobian[run, :, k, l].ravel(), atol=1e-12)
        if settles:
            maps.settle()
            assert np.allclose(cells.theta, theta, atol=1e-12)
            assert np.allclose(cells.jacobian, jacobian, atol=1e-12)
