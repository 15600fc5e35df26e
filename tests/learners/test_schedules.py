import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib import Rules
from recalib.learners import schedules

starts, ends = st.floats(0.2, 5), st.floats(0.01, 0.19)


@pytest.mark.parametrize("n", [3, 6])
@pytest.mark.parametrize(("spread", "scale"), [("widths", np.asarray), ("logarithms", np.log)])
@given(start=starts, end=ends)
def test_time_at_each_width_is_inversely_proportional_to_the_expected_learning(
    n, spread, scale, start, end
):
    """The law of section 6: dt L(width), over every step of what is spread, is the same."""
    rules = Rules(True, True, True, True, dimensions=n, spread=spread)
    time, step = np.linspace(0.05, 0.95, 50), 1e-5
    before, width, after = (
        schedules.fall(start, end, time + shift, rules.width_power) for shift in (-step, 0, step)
    )
    pace = 2 * step / (scale(after) - scale(before))
    learned = pace * schedules.expected_learning(width, n, 2.0**n)
    assert np.allclose(learned / learned.mean(), 1, rtol=1e-4)


@pytest.mark.parametrize("dimensions", [1, 3])
def test_expected_learning_is_the_integral_of_the_neighbourhood(dimensions):
    """(10) far from the border, by brute force."""
    width, side = 0.15, 4.0
    points = np.random.default_rng(0).uniform(-side / 2, side / 2, (400_000, dimensions))
    mean = np.exp(-(points**2).sum(axis=1) / (2 * width**2)).mean()
    assert schedules.expected_learning(width, dimensions, side**dimensions) == pytest.approx(
        mean, rel=0.2 if dimensions == 3 else 0.02
    )
