"""Mean, heterogeneity and luck: found again where they were planted, as often as they say."""

import numpy as np
import pytest
from scipy.stats import t

from replication.judgement import hierarchy as module
from replication.judgement.hierarchy import hierarchy, student

EFFORTS = np.array(["full", "rough"])


def world(random, setups=64, mean=0.0, own=0.1, luck=(0.1, 0.1), replicates=2):
    """Values (setup, replicate), groups of luck, and the number of one more setup."""
    true = mean + own * random.normal(size=setups + 1)
    group = np.arange(setups) % 2
    spread = np.array(luck)[group, None]
    values = true[:-1, None] + spread * random.normal(size=(setups, replicates))
    return values, EFFORTS[group], true[-1]


def test_what_was_planted_is_found_again():
    """In a world so large that nothing but the truth fits."""
    values, groups, _ = world(np.random.default_rng(1), 1000, 0.3, 0.2, (0.1, 0.4))
    found = hierarchy(values, groups)
    assert found.mean.mean == pytest.approx(0.3, abs=0.03)
    assert found.heterogeneity.mean == pytest.approx(0.2, abs=0.03)
    assert found.luck.mean == pytest.approx(np.sqrt((0.1**2 + 0.4**2) / 2), rel=0.1)
    low, high = (each - 0.3 for each in found.another[1:])
    assert (-low, high) == pytest.approx((1.96 * 0.2,) * 2, rel=0.15)
    for estimate in found[:3]:
        assert estimate.low < estimate.mean < estimate.high
    of_numbers = found.luck_of_numbers[:2]
    assert of_numbers == pytest.approx(np.array([0.1, 0.4]) / np.sqrt(2), rel=0.1)
    assert found.numbers == pytest.approx(values.mean(axis=1))


def test_the_mean_has_students_interval():
    values = np.random.default_rng(2).normal(size=9)
    found = student(values)
    half = t.ppf(0.975, 8) * values.std(ddof=1) / 3
    assert found == pytest.approx((values.mean(), values.mean() - half, values.mean() + half))


# Trials of the BCG vaccine (Colditz et al. 1994, JAMA 271): vaccinated with and without
# tuberculosis, others with and without. Log risk ratios have known variances.
BCG = np.array(
    [
        [4, 119, 11, 128],
        [6, 300, 29, 274],
        [3, 228, 11, 209],
        [62, 13536, 248, 12619],
        [33, 5036, 47, 5761],
        [180, 1361, 372, 1079],
        [8, 2537, 10, 619],
        [505, 87886, 499, 87892],
        [29, 7470, 45, 7232],
        [17, 1699, 65, 1600],
        [186, 50448, 141, 27197],
        [5, 2493, 3, 2338],
        [27, 16886, 29, 17825],
    ]
)


def test_the_variance_between_trials_is_the_published_one():
    """Viechtbauer (2007): Paule and Mandel's estimate, and the interval of Q's profile.

    There luck is known: here, it has a million degrees of freedom, and a group for each trial.
    """
    with_it, without, others, healthy = BCG.T.astype(float)
    ratios = np.log(with_it / (with_it + without)) - np.log(others / (others + healthy))
    variances = 1 / with_it - 1 / (with_it + without) + 1 / others - 1 / (others + healthy)
    count = len(BCG)
    estimate, draws = module._own_variances(
        ratios, variances, np.arange(count), np.full(count, 10**6)
    )
    assert estimate == pytest.approx(0.318, abs=0.001)
    # the quantiles of draws are spread evenly, but there are 1,024 of them
    assert np.quantile(draws, [0.025, 0.975]) == pytest.approx((0.120, 1.115), rel=0.04)


def test_without_heterogeneity_the_estimate_is_zero_in_half_of_the_studies():
    """Q is below its expectation in a bit more than half of them: chi-squared is skewed."""
    found = [
        hierarchy(*world(np.random.default_rng([3, n]), 32, own=0.0, luck=(0.05, 0.5))[:2])
        for n in range(60)
    ]
    zeros = np.mean([each.heterogeneity.mean == 0 for each in found])
    assert 0.3 <= zeros <= 0.72, "0.52, and three binomial standard deviations"
    excluded = np.mean([each.heterogeneity.low > 0 for each in found])
    assert excluded <= 0.1


def test_luck_of_one_group_says_nothing_of_anothers():
    values, groups, _ = world(np.random.default_rng(5), 200, luck=(0.0, 0.4))
    found = hierarchy(values, groups)
    assert found.luck_of_numbers[0] == pytest.approx(0, abs=1e-12)
    assert found.luck_of_numbers[1] == pytest.approx(0.4 / np.sqrt(2), rel=0.15)
    # a chi-squared interval of the rough half alone: 100 degrees of freedom
    assert found.luck.high / found.luck.low == pytest.approx(np.sqrt(129.56 / 74.22), rel=0.01)


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    own, luck, inside = 0.3, (0.13, 0.39), []
    for number in range(250):
        random = np.random.default_rng([7, number])
        values, groups, another = world(random, mean=0.1, own=own, luck=luck)
        found = hierarchy(values, groups)
        truths = 0.1, own, np.sqrt(np.square(luck).mean()), another
        parts = found.mean, found.heterogeneity, found.luck, found.another
        inside.append([each.low <= it <= each.high for each, it in zip(parts, truths, strict=True)])
    shares = np.mean(inside, axis=0)
    assert ((shares >= 0.92) & (shares <= 0.98)).all(), shares
