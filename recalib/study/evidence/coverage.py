"""Do intervals hold? Half of the searches give one, the other half the number that is to be in it.

The study is repeated in small within itself: see `recalib.study.statistics`.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from recalib.study.configuration.switches import SWITCHES
from recalib.study.evidence.claims.switches import ask_for, with_and_without
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.statistics import Draws, combined, ratio_searched_once

if TYPE_CHECKING:
    import pandas as pd

SPLITS = 200


def needs(ask: Request) -> None:
    """What the table is made from."""
    ask_for(ask, SWITCHES)


def coverage(evidence: Evidence) -> "pd.DataFrame":
    """How often the interval from one half of the searches holds the other half's number.

    A row for each effect: that of a change on the improved system, or on Ritter's; with where a
    study would find it that searches only once.
    """
    import pandas as pd  # half a second, which the workflow would pay whenever it starts

    rows = []
    for switch in SWITCHES:
        for label, pair in with_and_without(evidence, switch).items():
            luck = evidence.rng("coverage", switch.key, label)
            errors = [combined(evidence.errors(each)) for each in pair]
            inside = _inside(*map(np.log, errors), luck).mean()
            once = dict(zip(("once_low", "once_high"), ratio_searched_once(*errors), strict=True))
            rows.append({"change": switch.label, "effect": label, "inside": inside, **once})
    return pd.DataFrame(rows)


def _inside(ours: np.ndarray, theirs: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """For each split (split,), whether the number of one half lies in the other's interval."""
    halves = [_split(values, random.permuted) for values in (ours, theirs)]
    draws = Draws(random)
    numbers = np.subtract(*(draws.means(first) for first, _ in halves))
    repeated = np.subtract(*(second.mean(axis=(0, 1)) for _, second in halves))
    estimates = [draws.estimate(each) for each in numbers.T]
    return np.array(
        [each.low <= number <= each.high for each, number in zip(estimates, repeated, strict=True)]
    )


def _split(values: np.ndarray, permuted: Callable) -> tuple[np.ndarray, np.ndarray]:
    """Values (search, seed) in two halves, each (search, seed, split)."""
    order = permuted(np.tile(np.arange(len(values)), (SPLITS, 1)), axis=1)
    whole = np.moveaxis(values[order], 0, -1)
    return whole[: len(values) // 2], whole[len(values) // 2 :]
