"""Mean, heterogeneity and luck of a number that was measured in many setups, in some of them again.

A random-effects model: the number of a setup is the mean plus what is its own; each measurement
adds luck, which replicates of a setup show. All is in the scale of the values, such as logarithms.
A number of which only a bound is known, as at the end of a ladder of lengths, enters as such.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import chdtri, log_ndtr, ndtr, stdtrit

LEVEL = 0.95
TAILS = (1 - LEVEL) / 2, (1 + LEVEL) / 2  # of a distribution: what lies between them is the level
DRAWS = 1024  # of the pivot
HALVINGS = 40  # of an interval of 12 decades: to 1e-11
GRID = 200  # points along each parameter of a likelihood
NEGLIGIBLE = 1e-4  # times the largest likelihood


class Estimate(NamedTuple):
    """A number, and its 95 % interval."""

    mean: float
    low: float
    high: float


class Model(NamedTuple):
    """What many setups say together.

    Attributes:
        mean: over the setups.
        another: where the number of one more study, in another setup, would lie: heterogeneity and
            luck are in its interval.
        heterogeneity: standard deviation between setups without luck (Paule and Mandel), with the
            interval of a generalised Q.
        luck: standard deviation between replicates of a setup, with its chi-squared interval.
        numbers: (setup,) the mean of each setup's replicates.
    """

    mean: Estimate
    another: Estimate
    heterogeneity: Estimate
    luck: Estimate
    numbers: np.ndarray

    def shares(self, low: float, high: float) -> tuple[float, float, float]:
        """Which share of setups lies below, between and above two numbers, without luck."""
        own = max(self.heterogeneity.mean, 1e-12)
        below, within = (float(ndtr((limit - self.mean.mean) / own)) for limit in (low, high))
        return below, within - below, 1 - within


def model(values: np.ndarray, bounds: np.ndarray | None = None) -> Model:
    """The model fitted to values (setup, replicate); NaN where a setup has no such replicate.

    At least three setups have a first replicate, and one of them a second one.

    Args:
        bounds: (setup, replicate) 1 where the value is the least that the number can be, -1 where
            it is the most; 0 otherwise.
    """
    known = np.isfinite(values)
    counts, numbers = known.sum(axis=1), np.nanmean(values, axis=1)
    sides = np.zeros(len(values))
    if bounds is not None:
        sides = np.sign(np.where(known, bounds, 0).sum(axis=1))
    again = counts > 1
    several = values[again & (sides == 0) if np.any(again & (sides == 0)) else again]
    degrees = int((np.isfinite(several).sum(axis=1) - 1).sum())
    within = np.nansum(np.square(several - np.nanmean(several, axis=1, keepdims=True))) / degrees
    luck = Estimate(*np.sqrt([within, *(degrees * within / chdtri(degrees, TAILS))]).tolist())
    if sides.any():
        mean, another, total = _censored(numbers, sides)
        own = np.square(total) - within * np.mean(1 / counts)
        heterogeneity = Estimate(*np.sqrt(np.maximum(own, 0)).tolist())
    else:
        mean, another = _student(numbers)
        heterogeneity = _heterogeneity(numbers, within, degrees, counts)
    return Model(mean, another, heterogeneity, luck, numbers)


def student(values: np.ndarray) -> Estimate:
    """The mean of values (n,) with Student's interval."""
    return _student(values)[0]


def another(values: np.ndarray) -> Estimate:
    """The mean of values (n,) with Student's interval for one more of them."""
    return _student(values)[1]


def _student(values: np.ndarray) -> tuple[Estimate, Estimate]:
    """The mean of values (n,), and one more value; both with Student's intervals."""
    count, mean = len(values), values.mean()
    reach = stdtrit(count - 1, TAILS[1]) * values.std(ddof=1)
    mean_reach, another_reach = reach / np.sqrt(count), reach * np.sqrt(1 + 1 / count)
    return (
        Estimate(float(mean), float(mean - mean_reach), float(mean + mean_reach)),
        Estimate(float(mean), float(mean - another_reach), float(mean + another_reach)),
    )


def _censored(values: np.ndarray, sides: np.ndarray) -> tuple[Estimate, Estimate, Estimate]:
    """The same where some values are bounds, and the deviation: of a normal, by its likelihood.

    With the prior 1 / deviation, under which values without bounds have Student's intervals.
    """
    known = values[sides == 0] if np.sum(sides == 0) > 1 else values
    middle, width = known.mean(), max(known.std(ddof=1), 1e-3)
    means = middle + width * np.linspace(-5, 5, GRID)[:, None]
    deviations = width * np.geomspace(0.2, 10, GRID)[None]
    exact = values[sides == 0]
    squares = sum(np.square(means - value) for value in exact)
    log = -len(exact) * np.log(deviations) - 0.5 * squares / np.square(deviations)
    bounds, counts = np.unique(np.stack([values, sides])[:, sides != 0], axis=1, return_counts=True)
    for (value, side), count in zip(bounds.T, counts, strict=True):
        log = log + count * log_ndtr(side * (means - value) / deviations)
    weights = np.exp(log - log.max())  # on a logarithmic grid the prior 1 / deviation is flat
    weights /= weights.sum()
    expected = float((weights * means).sum())
    found = [_quantile(means[:, 0], np.cumsum(weights.sum(axis=1)), tail) for tail in TAILS]
    total = [_quantile(deviations[0], np.cumsum(weights.sum(axis=0)), p) for p in (0.5, *TAILS)]
    ends = middle + width * np.linspace(-20, 20, GRID)
    likely = weights > NEGLIGIBLE * weights.max()
    centres, widths = (np.broadcast_to(its, likely.shape)[likely] for its in (means, deviations))
    spread = ndtr((ends[:, None] - centres) / widths) @ weights[likely]
    beyond = [_quantile(ends, spread, tail) for tail in TAILS]
    return Estimate(expected, *found), Estimate(expected, *beyond), Estimate(*total)


def _quantile(points: np.ndarray, cumulated: np.ndarray, share: float) -> float:
    return float(np.interp(share, cumulated, points))


def _heterogeneity(numbers: np.ndarray, luck: float, degrees: int, counts: np.ndarray) -> Estimate:
    """Standard deviation of what is a setup's own, with the interval of a generalised pivot.

    The generalised Q of numbers (setup,) falls with it, and is distributed as chi-squared at the
    true one. Draws of it hold what is not known of luck, too (Weerahandi 1993).
    """
    freedom = len(numbers) - 1
    random = np.random.default_rng(0)
    targets = np.concatenate([[freedom], random.chisquare(freedom, DRAWS)])
    lucks = luck * np.concatenate([[1], degrees / random.chisquare(degrees, DRAWS)])
    variances = _own_variance(numbers, lucks[:, None] / counts, targets)
    low, high = np.quantile(variances[1:], TAILS)
    return Estimate(*np.sqrt([variances[0], low, high]).tolist())


def _own_variance(numbers: np.ndarray, luck: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Variances (draw,) between setups at which Q, given luck (draw, setup), has its target."""
    spread = max(numbers.var(), 1e-30)
    low, high = np.full(len(targets), 1e-9 * spread), np.full(len(targets), 1e3 * spread)

    def beyond(own: np.ndarray) -> np.ndarray:
        weights = 1 / (own[:, None] + luck)
        means = (weights @ numbers) / weights.sum(axis=1)
        return (weights * np.square(numbers - means[:, None])).sum(axis=1) > targets

    none = ~beyond(low)
    for _ in range(HALVINGS):
        middle = np.sqrt(low * high)
        more = beyond(middle)
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    return np.where(none, 0.0, low)
