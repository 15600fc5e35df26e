"""Averages over seeds with their intervals, and when a threshold is reached."""

from typing import NamedTuple

import numpy as np

LEVEL = 0.95
RESAMPLES = 2000


class Estimate(NamedTuple):
    """A mean and its 95 % bootstrap interval."""

    mean: float
    low: float
    high: float

    def columns(self, name: str) -> dict[str, float]:
        """The cells of a table: NAME, NAME_low and NAME_high."""
        return dict(zip((name, f"{name}_low", f"{name}_high"), self, strict=True))


def bootstrap(values: np.ndarray, random: np.random.Generator) -> Estimate:
    """The mean over seeds of the values (seed,), with its percentile bootstrap interval.

    The interval of a single seed is NaN.
    """
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return Estimate(float(values.mean()), np.nan, np.nan)
    means = values[random.integers(len(values), size=(RESAMPLES, len(values)))].mean(axis=1)
    low, high = np.quantile(means, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return Estimate(float(values.mean()), float(low), float(high))


def first_within(iterations: np.ndarray, errors: np.ndarray, thresholds: np.ndarray) -> float:
    """The first of the iterations at which all errors are within the thresholds.

    Args:
        iterations: (measurement,).
        errors: (measurement, kind).
        thresholds: (kind,).

    Infinite where that never happens.
    """
    within = np.all(errors <= thresholds, axis=-1)
    return float(iterations[within.argmax()]) if within.any() else np.inf


def paired_ratio(ours: np.ndarray, theirs: np.ndarray, random: np.random.Generator) -> Estimate:
    """Our errors over theirs (seed,), paired by seed: a geometric mean."""
    return Estimate(*np.exp(bootstrap(np.log(ours) - np.log(theirs), random)))


def share(hits: np.ndarray, random: np.random.Generator) -> Estimate:
    """The share of True among hits (n,)."""
    return bootstrap(np.asarray(hits, dtype=float), random)
