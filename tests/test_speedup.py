import numpy as np
import pytest

from recalib.study.evidence.speedup import iterations_needed, speed_up
from recalib.study.statistics import paired_ratio, share

RUNGS = np.array([100, 200, 400])


def test_the_first_rung_that_reaches_both_errors_counts():
    errors = np.array([[4, 2], [2, 2], [1, 1.0]])
    assert iterations_needed(RUNGS, errors, np.array([2, 2])) == pytest.approx(200)
    assert np.isnan(iterations_needed(RUNGS, errors, np.array([5, 5])))
    assert iterations_needed(RUNGS, errors, np.array([0.5, 5])) == np.inf


def test_between_rungs_the_number_is_interpolated_on_logarithmic_scales():
    errors = np.array([[4, 4], [2, 2], [1, 1.0]])
    assert iterations_needed(RUNGS, errors, np.array([np.sqrt(2), 9])) == pytest.approx(
        200 * np.sqrt(2)
    )


def ladder(rungs, scale, seeds=30, spread=0.1):
    rng = np.random.default_rng(0)
    return {rung: scale / rung * np.exp(spread * rng.normal(size=(seeds, 2))) for rung in rungs}


def test_a_learner_fifty_times_as_slow_is_found_to_be():
    slow, fast = ladder([1000, 4000, 16_000, 64_000], 5000), ladder([50, 100, 200, 400], 100)
    estimate = speed_up(slow, fast, 200, np.random.default_rng(1))
    assert estimate.low < estimate.mean < estimate.high and estimate.mean == pytest.approx(
        50, rel=0.1
    )
    assert speed_up(
        slow, fast, np.array([0.4, 0.4]), np.random.default_rng(1)
    ).mean == pytest.approx(50, rel=0.1)


def test_a_learner_that_never_gets_there_has_no_finite_factor():
    assert (
        speed_up(ladder([100, 200], 5000), ladder([200], 100), 200, np.random.default_rng(1)).mean
        == np.inf
    )


def test_ratios_are_paired():
    theirs = np.random.default_rng(0).lognormal(0, 1, 40)
    estimate = paired_ratio(0.8 * theirs, theirs, np.random.default_rng(1))
    assert tuple(estimate) == pytest.approx((0.8, 0.8, 0.8))


def test_shares():
    estimate = share(np.arange(100) < 30, np.random.default_rng(0))
    assert estimate.mean == pytest.approx(0.3) and estimate.low == pytest.approx(0.21, abs=0.02)
