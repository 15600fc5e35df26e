"""The first and the last errors of every training, with intervals."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.numerics.randomness import generator
from replication.judgement.intervals import Draws
from replication.training.measured import ERRORS, errors_of


def summarise(
    histories: list[Path], scenarios: list[Path], trainings: tuple[tuple[str, str], ...], seed: int
) -> pd.DataFrame:
    """A row for each training.

    Args:
        histories: files of the trainings.
        scenarios: files of all their scenarios as resolved.
        trainings: scenario and learner of each, in the order of the histories.
    """
    resolved = [json.loads(path.read_text(encoding="utf-8")) for path in scenarios]
    robots = {scenario["scenario"]: scenario["robot"] for scenario in resolved}
    return pd.DataFrame(
        [
            {"robot": robots[scenario], "scenario": scenario, "learner": learner}
            | _measured(pd.read_parquet(path), seed, scenario, learner)
            for (scenario, learner), path in zip(trainings, histories, strict=True)
        ]
    )


def _measured(history: pd.DataFrame, seed: int, scenario: str, learner: str) -> dict:
    cells = {
        "searches": history["search"].nunique(),
        "seeds": history["seed"].nunique(),
        "iterations": history["iteration"].max(),
        "moves": history["moves"].max(),
        "refused": history.groupby("seed")["refused"].max().sum(),
    }
    names = [f"{moment}_{error}" for moment in ("initial", "final") for error in ERRORS]
    values = np.concatenate([errors_of(history, when) for when in ("first", "last")], axis=-1)
    draws = Draws(generator(seed, "summary", scenario, learner), values)
    means = draws.means(values)  # once for all four numbers: drawing is what takes the time
    for index, name in enumerate(names):
        cells |= draws.estimate(means[:, index]).columns(name)
        cells[f"{name}_se"] = error_at_these_settings(values[..., index])
    return cells


def error_at_these_settings(values: np.ndarray) -> float:
    """Standard error of the mean of values (search, seed), where only the seeds were others."""
    by_search = values.var(axis=1, ddof=1)
    return float(np.sqrt(by_search.mean() / values.size))
