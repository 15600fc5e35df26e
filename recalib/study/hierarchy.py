"""Mean, heterogeneity and luck of a number that was measured a few times in each of many setups.

A balanced random-effects model: the number of a setup is the mean plus what is its own; each of its
replicates adds luck. Luck may differ between groups of setups, as it does between efforts of the
search. This is a meta-analysis in which every setup is a study (Viechtbauer 2007).
"""

from typing import NamedTuple

import numpy as np
from scipy.stats import chi2, t
from scipy.stats.qmc import Sobol

from recalib.study.statistics import LEVEL, Estimate

TAILS = (1 - LEVEL) / 2, (1 + LEVEL) / 2
DRAWS = 1024  # of the pivot
HALVINGS = 40  # of an interval of 12 decades: to 1e-11


class Hierarchy(NamedTuple):
    """What many setups say together; all in the unit of the values, such as logarithms.

    Attributes:
        mean: over the setups, with Student's interval: it holds heterogeneity and luck.
        heterogeneity: standard deviation between setups without luck (Paule and Mandel), with the
            interval of a generalised Q.
        luck: standard deviation between replicates of a setup, with its chi-squared interval.
        another: where 95 % of other setups would lie, without luck, about the mean.
        numbers: (setup,) the mean of each setup's replicates.
        luck_of_numbers: (setup,) standard deviation that luck gives each of them.
    """

    mean: Estimate
    heterogeneity: Estimate
    luck: Estimate
    another: Estimate
    numbers: np.ndarray
    luck_of_numbers: np.ndarray


def hierarchy(values: np.ndarray, groups: np.ndarray, draws: int = DRAWS) -> Hierarchy:
    """The model fitted to values (setup, replicate), with luck of its own in each group (setup,).

    At least three setups, and two replicates. `draws` is a power of two.
    """
    setups, replicates = values.shape
    numbers, within = values.mean(axis=1), values.var(axis=1, ddof=1)
    _, group = np.unique(groups, return_inverse=True)
    sizes = np.bincount(group)
    by_group = np.bincount(group, within) / sizes
    mean = student(numbers)
    freedom = sizes * (replicates - 1)
    heterogeneity = _heterogeneity(numbers, by_group / replicates, group, freedom, draws)
    error = np.sqrt(numbers.var(ddof=1) / setups)
    reach = t.ppf(TAILS[1], setups - 1) * np.hypot(error, heterogeneity.mean)
    return Hierarchy(
        mean,
        heterogeneity,
        _pooled(by_group, sizes, replicates - 1),
        Estimate(mean.mean, mean.mean - reach, mean.mean + reach),
        numbers,
        np.sqrt(by_group[group] / replicates),
    )


def student(values: np.ndarray) -> Estimate:
    """The mean of values (n,) with Student's interval."""
    mean, reach = values.mean(), t.ppf(TAILS[1], len(values) - 1) * values.std(ddof=1)
    reach /= np.sqrt(len(values))
    return Estimate(float(mean), float(mean - reach), float(mean + reach))


def _pooled(variances: np.ndarray, sizes: np.ndarray, freedom: int) -> Estimate:
    """Standard deviation from those of the groups (group,), each of so many setups.

    Its degrees of freedom are Satterthwaite's, since groups differ.
    """
    variance = np.average(variances, weights=sizes)
    if variance == 0:
        return Estimate(0.0, 0.0, 0.0)
    degrees = freedom * (sizes @ variances) ** 2 / (sizes @ variances**2)
    low, high = np.sqrt(degrees * variance / chi2.ppf(TAILS[::-1], degrees))
    return Estimate(float(np.sqrt(variance)), float(low), float(high))


def _heterogeneity(
    numbers: np.ndarray, by_group: np.ndarray, group: np.ndarray, freedom: np.ndarray, draws: int
) -> Estimate:
    """Standard deviation of what is a setup's own, from numbers (setup,) that have luck besides.

    The generalised Q falls with it, and is distributed as chi-squared at the true one. The interval
    holds what is not known of luck, too: it is that of a generalised pivot, whose draws are spread
    evenly instead of at random (Weerahandi 1993).

    Args:
        by_group: (group,) variance that luck gives a number, with so many degrees of `freedom`.
        group: (setup,) of each number.
    """
    evenly = Sobol(1 + len(by_group), rng=np.random.default_rng(0)).random(draws)
    targets = chi2.ppf(evenly[:, 0], len(numbers) - 1)
    luck = by_group * freedom / chi2.ppf(evenly[:, 1:], freedom)
    (middle,) = _own_variance(numbers, by_group[None, group], np.array([len(numbers) - 1.0]))
    low, high = np.quantile(_own_variance(numbers, luck[:, group], targets), TAILS)
    return Estimate(*(float(np.sqrt(each)) for each in (middle, low, high)))


def _own_variance(numbers: np.ndarray, luck: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Variances (draw,) between setups at which Q, given luck (draw, setup), has its target."""
    low = np.full(len(targets), 1e-9 * numbers.var())
    high = np.full(len(targets), 1e3 * numbers.var())

    def beyond(own: np.ndarray) -> np.ndarray:
        weights = 1 / (own[:, None] + luck)
        means = (weights @ numbers) / weights.sum(axis=1)
        return (weights * np.square(numbers - means[:, None])).sum(axis=1) > targets

    with np.errstate(divide="ignore", invalid="ignore"):  # all numbers the same
        none = ~beyond(low)
        for _ in range(HALVINGS):
            middle = np.sqrt(low * high)
            more = beyond(middle)
            low, high = np.where(more, middle, low), np.where(more, high, middle)
    return np.where(none, 0.0, low)
