"""What does a number depend on? The factors of the multiverse, each by itself.

The design is balanced, so that the other factors average out where one is looked at.
"""

import numpy as np
import pandas as pd

from replication.judgement.intervals import LEVEL, TAILS

RESAMPLES = 2000


def effects(numbers: np.ndarray, design: pd.DataFrame, random: np.random.Generator) -> pd.DataFrame:
    """How much each choice moves a number, first the one that most exceeds chance.

    Args:
        numbers: (setup,) in the scale in which they are averaged.
        design: (setup, factor) levels.
        random: of intervals and permutations.

    Returns a row for each factor: the level with the least and that with the largest mean,
    `effect`, the largest less the least, with its bootstrap interval, and `chance`: in 95 % of
    cases no factor without any effect exceeds its own (Bonferroni).
    """
    rows, rarely = [], (1 - LEVEL) / design.shape[1]
    for factor, levels in design.items():
        codes, names = pd.factorize(levels, sort=True)
        one_hot = np.eye(len(names))[codes]
        (means,) = _means(numbers[None], one_hot[None])
        drawn = random.integers(len(numbers), size=(RESAMPLES, len(numbers)))
        resampled = np.ptp(_means(numbers[drawn], one_hot[drawn]), axis=1)
        shuffled = random.permuted(np.tile(numbers, (RESAMPLES, 1)), axis=1)
        low, high = np.quantile(resampled, TAILS)
        rows.append(
            {
                "factor": factor,
                "least": names[means.argmin()],
                "largest": names[means.argmax()],
                "effect": np.ptp(means),
                "low": low,
                "high": high,
                "chance": np.quantile(np.ptp(_means(shuffled, one_hot[None]), axis=1), 1 - rarely),
            }
        )
    table = pd.DataFrame(rows)
    clearest = np.argsort(table["chance"] - table["effect"], kind="stable")
    return table.iloc[clearest].reset_index(drop=True)


def _means(numbers: np.ndarray, one_hot: np.ndarray) -> np.ndarray:
    """Means (n, level) of (n, universe), by level: (n or 1, universe, level)."""
    counts = np.maximum(one_hot.sum(axis=1), 1)
    return np.einsum("nu,nul->nl", numbers, one_hot) / counts
