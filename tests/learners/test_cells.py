"""Updates that are kept back and made together are the updates that they would be one by one."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from recalib.learners.cells import KEPT, Cells

RUNS, K, L, SHAPE = 3, 4, 2, (2, 3)
START = np.random.default_rng(0).normal(size=(K, L, *SHAPE))


def at_once(held, increments, rate, g_k, g_kl, target):
    """One update of all cells (run, K, L, ...): (4) and (5), or (7) and (9)."""
    weights = np.einsum("r,rk,rl->rkl", rate, g_k, g_kl)[..., None, None]
    target = target[:, None, None]
    return held + weights * (target if increments else target - held)


def draw(rng):
    """Rate, neighbourhoods and target of an update; some learn nothing, some all."""
    rate = rng.choice([0.0, 0.3, 1.0], RUNS)
    return (
        rate,
        rng.uniform(size=(RUNS, K)),
        rng.uniform(size=(RUNS, L)),
        rng.normal(size=(RUNS, *SHAPE)),
    )


@given(
    increments=st.booleans(),
    steps=st.lists(st.tuples(st.integers(0, KEPT + 5), st.booleans()), max_size=6),
    seed=st.integers(0, 100),
)
def test_any_sequence_equals_immediate_updates(increments, steps, seed):
    rng = np.random.default_rng(seed)
    cells, expected = Cells(RUNS, START, increments), np.stack([START] * RUNS)
    for updates, read_all in steps:
        for _ in range(updates):
            update = draw(rng)
            cells.update(*update)
            expected = at_once(expected, increments, *update)
        k, l = rng.integers(K, size=RUNS), rng.integers(L, size=RUNS)
        assert np.allclose(cells.at(k, l), expected[np.arange(RUNS), k, l], atol=1e-12)
        if read_all:
            assert np.allclose(cells.all, expected, atol=1e-12)
    assert np.allclose(cells.all, expected, atol=1e-12)
