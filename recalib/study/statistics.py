"""Averages over seeds with their intervals, and trials to a threshold."""

from typing import NamedTuple

import numpy as np

LEVEL = 0.95
RESAMPLES = 2000


class Estimate(NamedTuple):
    """A mean and its 95 % bootstrap interval."""

    mean: float
    low: float
    high: float


def bootstrap(values: np.ndarray, generator: np.random.Generator) -> Estimate:
    """The mean over seeds of the values (seed,) with its percentile bootstrap interval; NaN for the interval of one seed."""
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return Estimate(float(values.mean()), np.nan, np.nan)
    means = values[generator.integers(len(values), size=(RESAMPLES, len(values)))].mean(axis=1)
    low, high = np.quantile(means, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return Estimate(float(values.mean()), float(low), float(high))


def first_within(iterations: np.ndarray, errors: np.ndarray, thresholds: np.ndarray) -> float:
    """The first of the iterations (measurement,) at which all errors (measurement, kind) are within the thresholds (kind,).

    Infinity where that never happens.
    """
    within = np.all(errors <= thresholds, axis=-1)
    return float(iterations[within.argmax()]) if within.any() else np.inf


def paired_ratio(ours: np.ndarray, theirs: np.ndarray, generator: np.random.Generator) -> Estimate:
    """Our errors over theirs (seed,), paired by seed: the exponential of the mean difference of logarithms."""
    return Estimate(*np.exp(bootstrap(np.log(ours) - np.log(theirs), generator)))


def share(hits: np.ndarray, generator: np.random.Generator) -> Estimate:
    """The share of True among hits (n,), with its bootstrap interval."""
    return bootstrap(np.asarray(hits, dtype=float), generator)
