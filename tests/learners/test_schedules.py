import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from recalib.learners import schedules

POWERS = [
    *schedules.RATES.values(),
    *(schedules.equal_visits(n, spread) for n in (3, 6) for spread in schedules.SPREADS),
]
starts, ends = st.floats(0.2, 5), st.floats(0.01, 0.19)


@pytest.mark.parametrize("power", POWERS)
@given(start=starts, end=ends)
def test_what_falls_falls_from_start_to_end(power, start, end):
    values = schedules.fall(start, end, np.linspace(0, 1, 50), power)
    assert values[0] == pytest.approx(start) and values[-1] == pytest.approx(end)
    assert (np.diff(values) < 0).all()


@pytest.mark.parametrize("n", [3, 6])
@pytest.mark.parametrize(("spread", "scale"), [("widths", np.asarray), ("logarithms", np.log)])
@given(start=starts, end=ends)
def test_time_at_each_width_is_inversely_proportional_to_the_expected_learning(
    n, spread, scale, start, end
):
    """The law of section 6: dt L(width), over every step of what is spread, is the same."""
    time, step = np.linspace(0.05, 0.95, 50), 1e-5
    before, width, after = (
        schedules.fall(start, end, time + shift, schedules.equal_visits(n, spread))
        for shift in (-step, 0, step)
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
