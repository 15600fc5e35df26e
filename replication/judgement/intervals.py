"""Averages over searches and seeds with intervals that contain both, and the typical search.

What is averaged has the axes (search, seed, ...): the winner of each search was trained with seeds
of its own. An interval answers: where would the number lie if the whole study were repeated, with
as many other searches and seeds? It is hierarchical: searches are drawn first, then seeds within
them. Seeds stand for poses, which all trainings share, so that one drawing of them serves all;
searches are a training's own.
"""

from typing import NamedTuple

import numpy as np

LEVEL = 0.95
TAILS = (1 - LEVEL) / 2, (1 + LEVEL) / 2  # of a distribution: what lies between them is the level
RESAMPLES = 20_000


class Estimate(NamedTuple):
    """A number, and the interval in which 95 % of repetitions of the study would find theirs."""

    mean: float
    low: float
    high: float

    def columns(self, name: str) -> dict[str, float]:
        """The cells of a table: NAME, NAME_low and NAME_high."""
        return dict(zip((name, f"{name}_low", f"{name}_high"), self, strict=True))


UNKNOWN = Estimate(np.nan, np.nan, np.nan)


class Draws:
    """Studies drawn from one with replacement: the study itself first, then RESAMPLES of it.

    A bootstrap of few searches is too narrow, and reaches no farther than the best and the worst of
    them. So what is drawn is spread around the study itself, on a logarithmic scale, until a mean's
    interval is Student's (Hesterberg 2015, section 4.3), and sqrt(2) times as wide, since a
    repetition has luck of its own (Spence and Stanley 2016). Of many trainings, the two with the
    fewest searches count.

    Args:
        random: of the draws.
        trainings: whose values (search, seed, ...) will be asked for, all above zero.
    """

    def __init__(self, random: np.random.Generator, *trainings: np.ndarray):
        from scipy.special import stdtrit  # a tenth of a second, which only judging needs

        self._random = random
        self._of_seeds: dict[tuple[int, ...], np.ndarray] = {}
        fewest, *more = sorted(map(len, trainings))[:2]
        self._known = fewest > 1
        if self._known:
            student = stdtrit(sum(size - 1 for size in (fewest, *more)), TAILS[1])
            self._spread = np.sqrt(2 * fewest / (fewest - 1)) * student / stdtrit(np.inf, TAILS[1])

    def means(self, values: np.ndarray) -> np.ndarray:
        """Arithmetic means (1 + RESAMPLES, ...) of a training's values (search, seed, ...)."""
        return self._spread_out(self._drawn(values))

    def geometric_means(self, values: np.ndarray) -> np.ndarray:
        """Geometric means (1 + RESAMPLES, ...) of a training's values (search, seed, ...)."""
        return self._spread_out(np.exp(self._drawn(np.log(values))))

    def estimate(self, numbers: np.ndarray) -> Estimate:
        """The estimate from what follows from means in each study, (1 + RESAMPLES,).

        The interval is NaN where a training has a single search.
        """
        bounds = np.quantile(numbers[1:], TAILS, method="closest_observation")
        return Estimate(float(numbers[0]), *(bounds if self._known else (np.nan, np.nan)))

    def _drawn(self, values: np.ndarray) -> np.ndarray:
        shape = searches, _ = values.shape[:2]
        if shape not in self._of_seeds:
            self._of_seeds[shape] = self._weights(*shape)
        by_search = np.einsum("nks,ks...->nk...", self._of_seeds[shape], values)
        return np.einsum("nk,nk...->n...", self._weights(searches), by_search)

    def _spread_out(self, means: np.ndarray) -> np.ndarray:
        if not self._known:
            return means
        of_the_study = np.where(means[0] > 0, means[0], 1)  # an intact robot's error may be none
        return of_the_study * (means / of_the_study) ** self._spread

    def _weights(self, *shape: int) -> np.ndarray:
        """How much each part weighs in each study (1 + RESAMPLES, ..., part); 1 in all."""
        *groups, parts = shape
        drawn = self._random.multinomial(parts, np.full(parts, 1 / parts), (RESAMPLES, *groups))
        return np.concatenate([np.ones((1, *shape)), drawn]) / parts


def bootstrap(values: np.ndarray, random: np.random.Generator) -> Estimate:
    """The mean of values (seed,), with its own percentile bootstrap interval, not a repetition's.

    The interval of a single seed is NaN.
    """
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return Estimate(float(values.mean()), np.nan, np.nan)
    means = values[random.integers(len(values), size=(2000, len(values)))].mean(axis=1)
    low, high = np.quantile(means, TAILS)
    return Estimate(float(values.mean()), float(low), float(high))


def estimate(values: np.ndarray, random: np.random.Generator) -> Estimate:
    """The mean of values (search, seed)."""
    draws = Draws(random, values)
    return draws.estimate(draws.means(values))


def geometric(values: np.ndarray, random: np.random.Generator) -> Estimate:
    """The geometric mean of values (search, seed)."""
    draws = Draws(random, values)
    return draws.estimate(draws.geometric_means(values))


def ratio(ours: np.ndarray, theirs: np.ndarray, random: np.random.Generator) -> Estimate:
    """The geometric mean of our errors (search, seed) over that of theirs, of another training."""
    draws = Draws(random, ours, theirs)
    return draws.estimate(draws.geometric_means(ours) / draws.geometric_means(theirs))


def combined(errors: np.ndarray) -> np.ndarray:
    """Geometric mean (...) of both errors (..., 2), by which learners are compared."""
    return np.sqrt(errors.prod(axis=-1))


def typical(errors: np.ndarray) -> int:
    """Which search is the median one by its errors (search, seed, 2): of two, the better.

    The first one is number 0.
    """
    by_search = combined(errors).mean(axis=1)
    return int(np.argsort(by_search, kind="stable")[(len(by_search) - 1) // 2])


def first_within(iterations: np.ndarray, errors: np.ndarray, thresholds: np.ndarray) -> float:
    """The first of iterations (measurement,) at which all errors are within their thresholds.

    Errors are (measurement, kind), thresholds (kind,). Infinite where that never happens.
    """
    within = np.all(errors <= thresholds, axis=-1)
    return float(iterations[within.argmax()]) if within.any() else np.inf
