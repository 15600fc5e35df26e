"""Mean, heterogeneity and noise. Their coverage is tested in campaign/test_table_to_verdict."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student_t

from replication.judgement import hierarchy, model, strongest, student

# Trials of the BCG vaccine (Colditz et al. 1994, JAMA 271): vaccinated with and without
# tuberculosis, others with and without. Log risk ratios have known variances.
BCG = """4 119 11 128; 6 300 29 274; 3 228 11 209; 62 13536 248 12619; 33 5036 47 5761;
    180 1361 372 1079; 8 2537 10 619; 505 87886 499 87892; 29 7470 45 7232; 17 1699 65 1600;
    186 50448 141 27197; 5 2493 3 2338; 27 16886 29 17825"""
BCG = np.array([trial.split() for trial in BCG.split(";")], int)


def test_the_variance_between_trials_is_the_published_one():
    """Viechtbauer (2007): Paule and Mandel's estimate, and the interval of Q's profile."""
    with_it, without, others, healthy = BCG.T.astype(float)
    ratios = np.log(with_it / (with_it + without)) - np.log(others / (others + healthy))
    variances = 1 / with_it - 1 / (with_it + without) + 1 / others - 1 / (others + healthy)
    targets = np.array([12, 23.337, 4.404])  # the mean and both tails of chi-squared
    found = hierarchy._own_variance(ratios, np.tile(variances, (3, 1)), targets)
    assert found == pytest.approx([0.318, 0.120, 1.115], rel=0.005)


def test_a_mean_has_students_interval_and_another_setup_a_wider_one():
    values = np.random.default_rng(1).normal(size=12)
    half = student_t.ppf(0.975, 11) * values.std(ddof=1)
    mean, ends = values.mean(), half * np.array([0, -1, 1])
    assert student(values) == pytest.approx(mean + ends / np.sqrt(12))
    assert hierarchy.another(values) == pytest.approx(mean + ends * np.sqrt(1 + 1 / 12))


def table(own, noise=0.1, seed=0):
    rng = np.random.default_rng(seed)
    values = np.full((30, 2), np.nan)
    setups = 0.5 + own * rng.normal(size=30)
    values[:, 0] = setups + noise * rng.normal(size=30)
    values[:10, 1] = setups[:10] + noise * rng.normal(size=10)
    return values


def test_luck_is_told_from_what_is_a_setups_own():
    alike = model(table(own=0.0, noise=0.3))
    assert alike.heterogeneity.low == 0
    below, within, above = (
        model(table(own=0.4))
        ._replace(mean=hierarchy.Estimate(0, 0, 0), heterogeneity=hierarchy.Estimate(1, 1, 1))
        .shares(-1.96, 1.96)
    )
    assert (below, within, above) == pytest.approx((0.025, 0.95, 0.025), abs=1e-4)


def test_a_bound_counts_as_one_and_not_as_a_number():
    """Where every third value is cut off, its mean is too small, and the likelihood's is not."""
    values = table(own=0.4)
    end = np.nanquantile(values, 2 / 3)
    cut, bounds = np.minimum(values, end), (values > end).astype(int)
    whole, known, naive = (
        model(*arguments).mean.mean for arguments in ((values,), (cut, bounds), (cut,))
    )
    assert abs(known - whole) < 0.05 < whole - naive


SETUPS = 30


def levels(random) -> pd.DataFrame:
    factors = {name: np.arange(SETUPS) % count for name, count in (("a", 2), ("b", 3), ("c", 5))}
    return pd.DataFrame({name: random.permutation(column) for name, column in factors.items()})


def test_the_factor_that_moves_a_number_is_named():
    random = np.random.default_rng(1)
    design = levels(random)
    numbers = 0.1 * random.normal(size=SETUPS) + 0.2 * (design["b"] == 2)
    assert strongest(numbers.to_numpy(), design) == "b"


def test_in_95_percent_no_factor_without_effect_is_named():
    named = 0
    for repetition in range(200):
        random = np.random.default_rng(repetition)
        named += strongest(random.normal(size=SETUPS), levels(random)) is not None
    assert named <= 19, "of 200: the binomial's 99 %"
    design = pd.DataFrame({"a": ["x", "y", "z"], "b": ["x", "x", "x"]})
    assert strongest(np.array([0.0, 5.0, 9.0]), design) is None
