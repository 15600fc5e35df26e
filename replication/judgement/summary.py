"""The initial and final errors of every training, with intervals."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.special import stdtrit

from replication.config.study import Study
from replication.judgement.hierarchy import TAILS
from replication.training.measured import ERRORS
from replication.training.plan import places


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
