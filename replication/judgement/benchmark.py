"""Tables of the benchmark and of the real arm: errors, and moves to each threshold."""

from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from replication.config.study import Benchmark, Study
from replication.judgement.summary import cells_of_mean
from replication.training.measured import BOTH, ERRORS


def put_together(study: Study, histories: Sequence[Path]) -> tuple[pd.DataFrame, ...]:
    """The benchmark's two tables, from files of histories: `errors` and `reached`."""
    history = pd.concat(map(pd.read_parquet, histories))
    return errors(study.benchmark, history), reached(study.benchmark, history)


def _competitors(plan: Benchmark, history: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    groups = history.groupby(["scenario", "learner"])
    for competitor in product(plan.scenarios, (*plan.learners, *plan.papers)):
        yield *competitor, groups.get_group(competitor)


def errors(plan: Benchmark, history: pd.DataFrame) -> pd.DataFrame:
    """Both errors with their intervals, a row for each scenario, learner and budget of moves."""
    rows = []
    for scenario, learner, own in _competitors(plan, history):
        for moves, measured in own.groupby("moves"):
            row = {"scenario": scenario, "learner": learner, "moves": moves, "seeds": len(measured)}
            for error in ERRORS:
                row |= cells_of_mean(error, measured[error].to_numpy())
            rows.append(row)
    return pd.DataFrame(rows)


def reached(plan: Benchmark, history: pd.DataFrame) -> pd.DataFrame:
    """Moves to each threshold: medians over seeds, with the 5th and the 95th percentile."""
    rows = []
    for scenario, learner, runs in _competitors(plan, history):
        for error, threshold in product((*ERRORS, BOTH), plan.thresholds):
            moves = moves_to_reach(runs, ERRORS if error == BOTH else (error,), threshold)
            low, median, high = np.quantile(moves, [0.05, 0.5, 0.95], method="nearest")
            labels = {"scenario": scenario, "learner": learner, "error": error}
            cells = {"threshold": threshold, "moves": median, "low": low, "high": high}
            rows.append(labels | cells)
    return pd.DataFrame(rows)


def moves_to_reach(history: pd.DataFrame, errors: Sequence[str], threshold: float) -> np.ndarray:
    """Moves (seed,) of the first measurement with all of these errors within the threshold.

    Infinity if there is none.
    """
    reached = (history[list(errors)] <= threshold).all(axis=1)
    within = history[reached].groupby("seed")["moves"].min()
    return (
        within.astype(float)
        .reindex(np.sort(history["seed"].unique()), fill_value=np.inf)
        .to_numpy()
    )


def real_errors(runs: Sequence[Path]) -> pd.DataFrame:
    """Errors on the real arm: a row for each learner and number of poses, or moves on its twin.

    Args:
        runs: files with a row for each of their subsets.
    """
    rows = []
    table = pd.concat(map(pd.read_csv, runs))
    for (learner, twin, poses), own in table.groupby(["learner", "twin", "poses"], sort=False):
        cells = {"learner": learner, "twin": twin, "poses": poses, "subsets": len(own)}
        error = own["position_error_mm"].to_numpy()
        rows.append(cells | cells_of_mean("position_error_mm", error))
    return pd.DataFrame(rows)
