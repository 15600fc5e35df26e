"""Intervals say where repetitions lie: of studies whose luck is drawn here, again and again."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm
from scipy.stats import t as student

from replication.judgement import intervals
from replication.judgement.intervals import (
    Draws,
    bootstrap,
    combined,
    estimate,
    first_within,
    geometric,
    ratio,
    typical,
)
from replication.training.measured import ERRORS, errors_of
from tests.synthetic import OF_SEARCHES, OF_SEEDS

SEEDS = 5


def rng(*keys):
    return np.random.default_rng(keys)


def training(random, searches, of_searches=OF_SEARCHES, of_seeds=OF_SEEDS):
    """Errors (search, seed) around 1."""
    luck = of_searches * random.normal(size=(searches, 1))
    return np.exp(luck + of_seeds * random.normal(size=(searches, SEEDS)))


@pytest.fixture
def quick(monkeypatch):
    """A tenth of the resamples: enough for widths, and for shares of hundreds."""
    monkeypatch.setattr(intervals, "RESAMPLES", 2000)


@pytest.mark.parametrize("of_searches", [OF_SEARCHES, 0.4])
@pytest.mark.parametrize("compared", [1, 2], ids=["mean", "ratio"])
def test_the_interval_holds_repetitions_as_often_as_it_says(compared, of_searches, quick):
    judge, inside, searches = (geometric, ratio)[compared - 1], [], 4
    for number in range(200):
        random = rng(searches, number)
        studies = [
            [training(random, searches, of_searches) for _ in range(compared)] for _ in range(11)
        ]
        found = judge(*studies[0], rng(number))
        logarithms = np.log(studies[1:]).mean(axis=(2, 3))
        again = np.exp(logarithms[:, 0] - logarithms[:, 1:].sum(axis=1))
        inside.append(np.mean((found.low <= again) & (again <= found.high)))
    # three standard errors of 95 %; drawing seeds counts some of their luck twice, hence 99
    assert 0.93 <= np.mean(inside) <= 0.99


@pytest.mark.parametrize("searches", [(4,), (8,), (12,), (4, 4), (12, 4, 12)])
def test_of_normal_means_an_interval_is_students_of_the_fewest_searches(searches):
    """With as many degrees of freedom as the two trainings of the fewest have; for a repetition."""
    trainings = [
        np.exp(norm.ppf((np.arange(each) + 0.5) / each))[:, None] * 1.3 for each in searches
    ]
    draws = Draws(rng(1), *trainings)
    factors = np.prod([draws.geometric_means(each) for each in trainings], axis=0)
    found = draws.estimate(factors)
    fewest, *more = sorted(searches)[:2]
    variance = sum(np.var(np.log(each)) / len(each) for each in trainings)  # of the bootstrap
    wide = np.sqrt(2 * fewest / (fewest - 1) * variance)
    wide *= student.ppf(0.975, sum(each - 1 for each in (fewest, *more)))
    assert found.mean == pytest.approx(1.3 ** len(searches))
    assert np.log(found) == pytest.approx(np.log(found.mean) + wide * np.array([0, -1, 1]), rel=0.1)


def test_where_all_errors_are_none_so_is_the_interval():
    assert estimate(np.zeros((4, 5)), rng(1)) == (0, 0, 0)


def test_of_a_single_search_nothing_is_said_of_another():
    values = training(rng(2), 1)
    found = estimate(values, rng(1))
    assert found.mean == pytest.approx(values.mean()) and np.isnan(found[1:]).all()


def test_luck_that_both_trainings_share_by_seed_narrows_their_ratio(quick):
    poses = rng(3).normal(0, 1, (12, SEEDS))
    poses -= poses.mean(axis=1, keepdims=True)  # luck of seeds alone
    together = ratio(np.exp(poses), np.exp(poses), rng(4))
    apart = ratio(np.exp(poses), np.exp(poses[:, ::-1]), rng(4))
    assert np.log(together.high / together.low) < 0.85 * np.log(apart.high / apart.low)


def test_the_first_of_all_studies_is_the_one_itself():
    values = rng(0).lognormal(size=(4, 3, 2))
    means = Draws(rng(1), values).means(values)
    assert means.shape == (1 + intervals.RESAMPLES, 2)
    assert np.allclose(means[0], values.mean(axis=(0, 1)))


def test_means_of_ratios_are_geometric():
    ours, theirs = (training(rng(number), 3) for number in (0, 1))
    assert geometric(ours, rng(2)).mean == pytest.approx(np.exp(np.log(ours).mean()))
    assert ratio(ours, theirs, rng(2)).mean == pytest.approx(1 / ratio(theirs, ours, rng(2)).mean)


def test_the_typical_search_is_the_median_one_of_two_the_better():
    """Judged by the geometric mean of both errors, as everything is."""
    position = np.array([4.0, 1, 3, 2])
    errors = np.stack([position, 1 / position**3], axis=-1)[:, None].repeat(3, axis=1)
    assert combined(errors)[:, 0] == pytest.approx(1 / position)
    assert typical(errors) == 2, "of the two in the middle the one with the smaller error"
    assert typical(errors[:3]) == 2
    errors[1, 0] = 1e-3  # one seed of the worst
    assert typical(errors) == 2, "the mean over the seeds counts"


def test_the_errors_of_a_training_are_those_of_its_last_or_first_measurement():
    searches, seeds, iterations = (grid.ravel() for grid in np.mgrid[:2, :3, :3])
    history = pd.DataFrame({"search": searches, "seed": 3 * searches + seeds})
    history["iteration"] = np.array([0, 4, 10])[iterations]
    for factor, error in enumerate(ERRORS, start=1):
        history[error] = factor * (10.0 * history["seed"] + history["iteration"])
    shuffled = history.sample(frac=1, random_state=1)
    first, last = errors_of(shuffled, "first"), errors_of(shuffled)
    assert first.shape == last.shape == (2, 3, 2)
    assert np.array_equal(first[..., 0], [[0, 10, 20], [30, 40, 50]])
    assert np.array_equal(last, first + np.array([10, 20]))


def test_the_interval_over_seeds_covers_their_mean_as_often_as_it_says():
    covered = 0
    for repetition in range(200):
        values = rng(repetition).normal(3.0, 1.0, 30)
        found = bootstrap(values, rng(0))
        assert found.low < found.mean < found.high
        covered += found.low <= 3.0 <= found.high
    # 95 % less the known optimism of the percentile bootstrap at 30 values
    assert 178 <= covered <= 198


def test_one_seed_has_no_interval():
    found = bootstrap([2.0], rng(0))
    assert found.mean == 2.0 and np.isnan(found.low)


def test_a_threshold_counts_where_all_errors_are_within():
    iterations, errors = np.array([0, 10, 20]), np.array([[3, 3], [1, 3], [1, 1.0]])
    assert first_within(iterations, errors, np.array([1, 2])) == 20
    assert first_within(iterations, errors, np.array([0.5, 2])) == np.inf
