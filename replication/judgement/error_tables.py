"""Tables of errors with intervals: of every training, of the benchmark, and on the real arm."""

from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.special import stdtrit

from replication.config.study import Study
from replication.judgement.hierarchy import TAILS
from replication.training.measured import BOTH, ERRORS
from replication.training.plan import places

LABELS = ["scenario", "learner"]


def summarise(study: Study, histories: Sequence[Path]) -> pd.DataFrame:
    """A row for each place, learner and number of iterations; `histories` are in this order."""
    files, rows = iter(histories), []
    for place, learners in places(study).items():
        for learner, lengths in learners.items():
            table = pd.read_parquet(next(files))
            for iterations in lengths:
                labels = {**place._asdict(), "learner": learner, "iterations": iterations}
                rows.append(labels | _measured(table[table["iterations"] == iterations]))
    return pd.DataFrame(rows)


def _measured(history: pd.DataFrame) -> dict[str, float]:
    last = history[history["iteration"] == history["iterations"]]
    moments = {"initial": history[history["iteration"] == 0], "final": last}
    cells = {
        "seeds": len(last),
        "moves": last["moves"].max(),
        "refused": last["refused"].sum(),
    }
    for moment, table in moments.items():
        for error in ERRORS:
            cells |= cells_of_mean(f"{moment}_{error}", table[error].to_numpy())
    return cells


def cells_of_mean(name: str, values: np.ndarray) -> dict[str, float]:
    """The mean of errors (seed,), and its 95 % interval: cells NAME, NAME_low and NAME_high.

    The interval is Student's for the logarithm of the mean, so that it is positive. It is NaN if
    there is only one seed.
    """
    count, mean = len(values), values.mean()
    factor = np.nan
    if count > 1:
        reach = stdtrit(count - 1, TAILS[1]) * values.std(ddof=1) / np.sqrt(count)
        factor = np.exp(reach / mean) if mean > 0 else 1.0
    return {name: mean, f"{name}_low": mean / factor, f"{name}_high": mean * factor}


def put_together(study: Study, histories: Sequence[Path]) -> tuple[pd.DataFrame, ...]:
    """The benchmark's two tables, from files of histories.

    The first has both errors with their intervals, a row for each scenario, learner and number of
    moves. The second has moves to reach each threshold: medians and 5th and 95th percentiles.
    """
    plan, history = study.benchmark, pd.concat(map(pd.read_parquet, histories))
    groups = history.groupby(LABELS)
    errors, reached = [], []
    for competitor in product(plan.scenarios, (*plan.learners, *plan.papers)):
        runs, labels = groups.get_group(competitor), dict(zip(LABELS, competitor, strict=True))
        for moves, measured in runs.groupby("moves"):
            row = labels | {"moves": moves, "seeds": len(measured)}
            for error in ERRORS:
                row |= cells_of_mean(error, measured[error].to_numpy())
            errors.append(row)
        for error, threshold in product((*ERRORS, BOTH), plan.thresholds):
            moves = moves_to_reach(runs, ERRORS if error == BOTH else (error,), threshold)
            low, median, high = np.quantile(moves, [0.05, 0.5, 0.95], method="nearest")
            cells = {"threshold": threshold, "moves": median, "low": low, "high": high}
            reached.append(labels | {"error": error} | cells)
    return pd.DataFrame(errors), pd.DataFrame(reached)


def moves_to_reach(history: pd.DataFrame, errors: Sequence[str], threshold: float) -> np.ndarray:
    """Moves (seed,) of the first measurement with all these errors within the threshold, or inf."""
    reached = (history[list(errors)] <= threshold).all(axis=1)
    within = history[reached].groupby("seed")["moves"].min().astype(float)
    return within.reindex(np.sort(history["seed"].unique()), fill_value=np.inf).to_numpy()


def real_errors(runs: Sequence[Path]) -> pd.DataFrame:
    """Errors on the real arm: a row for each learner, twin and number of poses.

    Each file has a row for each random subset of the poses.
    """
    rows = []
    table = pd.concat(map(pd.read_csv, runs))
    for (learner, twin, poses), group in table.groupby(["learner", "twin", "poses"], sort=False):
        cells = {"learner": learner, "twin": twin, "poses": poses, "subsets": len(group)}
        error = group["position_error_mm"].to_numpy()
        rows.append(cells | cells_of_mean("position_error_mm", error))
    return pd.DataFrame(rows)
