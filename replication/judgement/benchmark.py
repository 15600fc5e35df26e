"""The benchmark's tables: errors at each budget of moves, moves to each threshold, seconds."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.numerics.randomness import generator
from replication.judgement.intervals import bootstrap
from replication.training.competitors import needs_of
from replication.training.measured import BOTH, ERRORS

Names = tuple[str, ...]


def put_together(
    histories: list[Path],
    scenarios: Names,
    learners: Names,
    thresholds: tuple[float, ...],
    seed: int,
) -> tuple[pd.DataFrame, ...]:
    """The three tables, from files of histories: see `errors`, `reached` and `seconds`."""
    history = pd.concat(map(pd.read_parquet, histories))
    those = history, scenarios, learners
    return errors(*those, seed), reached(*those, thresholds), seconds(history)


def _entrants(history: pd.DataFrame, scenarios: Names, learners: Names):
    groups = history.groupby(["scenario", "learner"])
    for competitor in product(scenarios, learners):
        yield *competitor, groups.get_group(competitor)


def errors(history: pd.DataFrame, scenarios: Names, learners: Names, seed: int) -> pd.DataFrame:
    """Both errors with their intervals, a row for each scenario, learner and budget of moves."""
    rows = []
    for scenario, learner, own in _entrants(history, scenarios, learners):
        for moves, measured in own.groupby("moves"):
            row = {"scenario": scenario, "learner": learner, "moves": moves, "seeds": len(measured)}
            for error in ERRORS:
                rng = generator(seed, scenario, learner, moves, error)
                row |= bootstrap(measured[error], rng).columns(error)
            rows.append(row)
    return pd.DataFrame(rows)


def reached(
    history: pd.DataFrame, scenarios: Names, learners: Names, thresholds: tuple[float, ...]
) -> pd.DataFrame:
    """Moves to each threshold: medians over seeds, with the 5th and the 95th percentile."""
    rows = []
    for scenario, learner, own in _entrants(history, scenarios, learners):
        for error, threshold in product((*ERRORS, BOTH), thresholds):
            moves = moves_to_reach(own, ERRORS if error == BOTH else (error,), threshold)
            low, median, high = np.quantile(moves, [0.05, 0.5, 0.95], method="nearest")
            about = {"scenario": scenario, "learner": learner, "error": error}
            its = {"threshold": threshold, "moves": median, "low": low, "high": high}
            rows.append(about | its | {"needs": needs_of(learner)})
    return pd.DataFrame(rows)


def moves_to_reach(history: pd.DataFrame, errors: Names, threshold: float) -> np.ndarray:
    """Moves (seed,) of the first measurement with all of these errors within the threshold.

    Infinity where there is none.
    """
    reached = (history[list(errors)] <= threshold).all(axis=1)
    within = history[reached].groupby("seed")["moves"].min()
    return (
        within.astype(float)
        .reindex(np.sort(history["seed"].unique()), fill_value=np.inf)
        .to_numpy()
    )


def seconds(history: pd.DataFrame) -> pd.DataFrame:
    """Mean computing time of a move. It differs from run to run, and has a file of its own."""
    return history.groupby("learner", sort=False)["seconds_per_move"].mean().reset_index()
