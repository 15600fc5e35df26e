"""Mean, heterogeneity and luck of a number that was measured a few times in each of many setups.

A balanced random-effects model: the number of a setup is the mean plus what is its own; each of its
replicates adds luck. Luck may differ between groups of setups, as it does between efforts of the
search. This is a meta-analysis in which every setup is a study (Viechtbauer 2007).
"""

from typing import NamedTuple

import numpy as np

from recalib.study.inference.intervals import TAILS, Estimate

# Of the logarithm of a ratio, by effort, when the second campaign was planned: what the first one
# showed for small effects (full: in the reference study; rough: over setups).
ASSUMED_LUCK = {"full": 0.13, "rough": 0.39}
DRAWS = 1024  # of the pivot
HALVINGS = 40  # of an interval of 12 decades: to 1e-11


class Hierarchy(NamedTuple):
    """What many setups say together; all in the unit of the values, such as logarithms.

    Attributes:
        mean: over the setups, with Student's interval: it holds heterogeneity and luck.
        heterogeneity: standard deviation between setups without luck (Paule and Mandel), with the
            interval of a generalised Q.
        luck: standard deviation between replicates of a setup, with its chi-squared interval.
        another: the mean, and where another setup would lie in 95 % of cases, without luck.
        numbers: (setup,) the mean of each setup's replicates.
        luck_of_numbers: (setup,) standard deviation that luck gives each of them.
    """

    mean: Estimate
    heterogeneity: Estimate
    luck: Estimate
    another: Estimate
    numbers: np.ndarray
    luck_of_numbers: np.ndarray


def hierarchy(values: np.ndarray, groups: np.ndarray) -> Hierarchy:
    """The model fitted to values (setup, replicate), with luck of its own in each group (setup,).

    At least three setups, and two replicates.
    """
    replicates = values.shape[1]
    numbers, within = values.mean(axis=1), values.var(axis=1, ddof=1)
    _, group = np.unique(groups, return_inverse=True)
    sizes = np.bincount(group)
    by_group = np.bincount(group, within) / sizes
    mean = student(numbers)
    freedom = sizes * (replicates - 1)
    own, draws = _own_variances(numbers, by_group / replicates, group, freedom)
    heterogeneity = Estimate(*np.sqrt([own, *np.quantile(draws, TAILS)]).tolist())
    return Hierarchy(
        mean,
        heterogeneity,
        _pooled(by_group, sizes, replicates - 1),
        _another(numbers, draws),
        numbers,
        np.sqrt(by_group[group] / replicates),
    )


def student(values: np.ndarray) -> Estimate:
    """The mean of values (n,) with Student's interval."""
    from scipy.special import stdtrit  # a fifth of a second, which no start needs

    mean, reach = values.mean(), stdtrit(len(values) - 1, TAILS[1]) * values.std(ddof=1)
    reach /= np.sqrt(len(values))
    return Estimate(float(mean), float(mean - reach), float(mean + reach))


def geometric_student(values: np.ndarray) -> Estimate:
    """The geometric mean of values (n,) above zero, with Student's interval of its logarithm."""
    return Estimate(*np.exp(student(np.log(values))).tolist())


def _pooled(variances: np.ndarray, sizes: np.ndarray, freedom: int) -> Estimate:
    """Standard deviation from those of the groups (group,), each of so many setups.

    Its degrees of freedom are Satterthwaite's, since groups differ.
    """
    from scipy.special import chdtri

    variance = np.average(variances, weights=sizes)
    if variance == 0:
        return Estimate(0.0, 0.0, 0.0)
    degrees = freedom * (sizes @ variances) ** 2 / (sizes @ variances**2)
    low, high = np.sqrt(degrees * variance / chdtri(degrees, TAILS))
    return Estimate(float(np.sqrt(variance)), float(low), float(high))


def _own_variances(
    numbers: np.ndarray, by_group: np.ndarray, group: np.ndarray, freedom: np.ndarray
) -> tuple[float, np.ndarray]:
    """Variance of what is a setup's own: the estimate, and draws of a generalised pivot.

    The generalised Q of numbers (setup,) falls with it, and is distributed as chi-squared at the
    true one. The draws hold what is not known of luck, too; they are spread evenly instead of at
    random (Weerahandi 1993).

    Args:
        by_group: (group,) variance that luck gives a number, with so many degrees of `freedom`.
        group: (setup,) of each number.
    """
    from scipy.special import chdtri

    evenly = _evenly(1 + len(by_group), 0)
    targets = chdtri(len(numbers) - 1, evenly[:, 0])
    luck = by_group * freedom / chdtri(freedom, evenly[:, 1:])
    (estimate,) = _own_variance(numbers, by_group[None, group], np.array([len(numbers) - 1.0]))
    return estimate, _own_variance(numbers, luck[:, group], targets)


def _another(numbers: np.ndarray, own: np.ndarray) -> Estimate:
    """Another setup, given draws (draw,) of the variance between setups."""
    from scipy.special import ndtri, stdtrit

    mean, degrees = numbers.mean(), len(numbers) - 1
    error = np.sqrt(numbers.var(ddof=1) / len(numbers))
    evenly = _evenly(2, 1)
    drawn = mean + error * stdtrit(degrees, evenly[:, 0]) + np.sqrt(own) * ndtri(evenly[:, 1])
    return Estimate(float(mean), *np.quantile(drawn, TAILS).tolist())


def _evenly(dimensions: int, seed: int) -> np.ndarray:
    """Points (DRAWS, dimensions) of a scrambled Sobol sequence in the unit cube."""
    from scipy.stats.qmc import Sobol

    return Sobol(dimensions, rng=np.random.default_rng(seed)).random(DRAWS)


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
