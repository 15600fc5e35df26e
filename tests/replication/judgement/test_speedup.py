import numpy as np
import pytest

from replication.judgement import intervals
from replication.judgement.speedup import iterations_needed, speed_up

RUNGS = np.array([100, 200, 400])


def rng(seed=1):
    return np.random.default_rng(seed)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """A tenth of the resamples: enough to see an interval."""
    monkeypatch.setattr(intervals, "RESAMPLES", 2000)


def test_between_rungs_the_number_is_interpolated_on_logarithmic_scales():
    errors = np.array([[4, 4], [2, 2], [1, 1.0]])
    needed = iterations_needed(RUNGS, errors, np.array([np.sqrt(2), 9]))
    assert needed == pytest.approx(200 * np.sqrt(2))


def needed_by_one(rungs, errors, target) -> float:
    """What `iterations_needed` computes for many at once, rung after rung."""
    worse = [max(one / goal for one, goal in zip(pair, target, strict=True)) for pair in errors]
    if worse[0] <= 1:
        return np.nan
    for index in range(1, len(rungs)):
        if worse[index] <= 1:
            share = np.log(worse[index - 1]) / np.log(worse[index - 1] / worse[index])
            return rungs[index - 1] * (rungs[index] / rungs[index - 1]) ** share
    return np.inf


def test_a_ladder_that_never_gets_there_is_no_matter_how_flat():
    flat = np.array([[2, 2], [2 - 1e-12, 2], [2, 2]])
    for rungs in (1, 3):
        assert iterations_needed(RUNGS[:rungs], flat[:rungs], np.array([1, 1])) == np.inf


def test_many_ladders_at_once_are_as_one_by_one():
    errors = rng().lognormal(0, 1, (300, 3, 2))
    targets = rng(2).lognormal(0.3, 1, (300, 2))
    one_by_one = [needed_by_one(RUNGS, *case) for case in zip(errors, targets, strict=True)]
    assert np.allclose(iterations_needed(RUNGS, errors, targets), one_by_one, equal_nan=True)
    finite, missing = np.isfinite(one_by_one), np.isnan(one_by_one)
    assert min(finite.sum(), missing.sum(), np.isinf(one_by_one).sum()) > 20, "each kind is there"


def ladder(rungs, scale, searches=6, spread=0.1):
    """Errors (search, seed, 2) that fall with the iterations."""
    random = rng(0)
    luck = (spread * random.normal(size=(searches, 5, 2)) for _ in rungs)
    return {rung: scale / rung * np.exp(each) for rung, each in zip(rungs, luck, strict=True)}


SLOW, FAST = ladder([1000, 4000, 16_000, 64_000], 5000, searches=4), ladder([50, 100, 200], 100)


@pytest.mark.parametrize("target", [200, np.array([0.7, 0.7])], ids=["rung", "errors"])
def test_a_learner_fifty_times_as_slow_is_found_to_be(target):
    [found] = speed_up(SLOW, FAST, [target], rng())
    assert found.low < found.mean < found.high and found.mean == pytest.approx(50, rel=0.1)


def test_the_factor_is_that_of_the_means():
    goal = FAST[200].mean(axis=(0, 1))
    means = np.stack([errors.mean(axis=(0, 1)) for errors in SLOW.values()])
    [found] = speed_up(SLOW, FAST, [200], rng())
    assert found.mean == pytest.approx(needed_by_one([*SLOW], means, goal) / 200)


def test_a_learner_that_never_gets_there_has_no_finite_factor():
    assert speed_up(ladder([100, 200], 5000), FAST, [200], rng())[0].mean == np.inf
    neither = speed_up(SLOW, FAST, [np.array([0.01, 0.01])], rng())
    assert np.isnan(neither[0].mean), "nor does the fast"


def test_where_the_fast_learner_sometimes_does_not_get_there_the_lower_end_is_open():
    [found] = speed_up(SLOW, FAST, [np.array([0.51, 0.51])], rng())
    assert found.low == 0 and np.isfinite(found.mean)


def test_targets_together_are_those_alone():
    targets = [200, np.array([0.7, 0.7])]
    alone = [speed_up(SLOW, FAST, [target], rng())[0] for target in targets]
    assert speed_up(SLOW, FAST, targets, rng()) == alone


def test_where_some_draws_do_not_get_there_the_upper_end_is_open():
    barely = {1000: SLOW[1000], 11_000: ladder([11_000], 5500, searches=4)[11_000]}
    [found] = speed_up(barely, FAST, [200], rng())
    assert np.isinf(found.high) and np.isfinite(found.low)
