"""Tables of the benchmark and of the real arm for pages."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from replication.config.study import Benchmark as Plan
from replication.pages.formats import short
from replication.training.competitors import label_of, peers
from replication.training.measured import BOTH, ERRORS

HYBRID = "hybrid"
WORSE = 1.1  # factor: a larger ratio to the best peer's error counts as worse
NEGLIGIBLE = 1e-4  # cm and degrees: smaller errors are rounding
FIRST = 4  # moves; with fewer, the hybrid is not compared with the best peer


Table = dict[str, list[str]]  # a page's table: cells by the name of their row


class Worse(NamedTuple):
    """A comparison in which the hybrid is worse than the best other peer, with the error ratio."""

    scenario: str
    moves: int
    ratio: float


class Benchmark:
    """The results of the benchmark, from its two tables. The threshold is in cm and degrees."""

    def __init__(self, plan: Plan, errors: pd.DataFrame, reached: pd.DataFrame):
        self.errors, self.threshold = errors, min(plan.thresholds)
        both = (reached["threshold"] == self.threshold) & (reached["error"] == BOTH)
        self._reached = reached[both].set_index(["scenario", "learner"])
        self._compared = [budget for budget in plan.moves if budget >= FIRST]
        self.learners = list(errors["learner"].unique())
        self.labels = [label_of(name) for name in self.learners]
        self.seeds = int(errors["seeds"].max())

    @property
    def moves(self) -> Table:
        """Moves that each learner needs: a row for each scenario, a cell for each learner."""
        return {
            words(scenario): [_moves(self._reached.loc[scenario, name]) for name in self.learners]
            for scenario in self.errors["scenario"].unique()
        }

    @property
    def worse(self) -> list[Worse]:
        """Comparisons in which another learner of today is better than the hybrid."""
        errors = self.errors[self.errors["moves"].isin(self._compared)]
        others = errors[errors["learner"].isin({*peers()} - {HYBRID})]
        comparisons = []
        for row in errors[errors["learner"] == HYBRID].to_dict("records"):
            same = (others["scenario"] == row["scenario"]) & (others["moves"] == row["moves"])
            best = others.loc[same, list(ERRORS)].min()
            comparisons += [
                Worse(words(row["scenario"]), row["moves"], row[error] / best[error])
                for error in ERRORS
                if row[error] > max(WORSE * best[error], NEGLIGIBLE)
            ]
        return comparisons


def words(scenario: str) -> str:
    """A scenario's name as text."""
    return scenario.replace("_", " ")


def _moves(reached: pd.Series) -> str:
    """Moves until errors are below the threshold: the median, and quantiles if they differ."""
    median, low, high = reached[["moves", "low", "high"]]
    if not np.isfinite(median):
        return "-"
    if low == high:
        return short(median)
    return f"{short(median)} ({short(low)} to {short(high) if np.isfinite(high) else 'more'})"


def on_real_arm(table: pd.DataFrame, poses: Sequence[int]) -> Table:
    """Mean position errors [mm]: a row for each learner, a cell for each number of poses."""
    rows = zip(table["learner"], table["twin"], strict=True)
    named = table.assign(label=[label_of(name) + " on a twin" * twin for name, twin in rows])
    errors = named.pivot(index="label", columns="poses", values="position_error_mm")
    shown = errors.reindex(named["label"].unique(), columns=poses)
    return {
        str(label): ["-" if np.isnan(error) else f"{error:.3f}" for error in row]
        for label, row in zip(shown.index, shown.to_numpy(), strict=True)
    }


def ends_on_twin(table: pd.DataFrame) -> Table:
    """The number of moves and the final error [mm] of each learner on the twin."""
    last = table[table["twin"]].sort_values("poses").groupby("learner", sort=False).last()
    return {
        label_of(str(learner)): [short(row["poses"]), f"{row['position_error_mm']:.3f}"]
        for learner, row in last.iterrows()
    }
