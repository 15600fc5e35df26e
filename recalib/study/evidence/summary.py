"""The first and the last errors of every training, with intervals over seeds."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path

import pandas as pd

from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.measured import ERRORS
from recalib.study.statistics import bootstrap


def summarise(
    job: jobs.Summary, histories: Sequence[str | Path], scenarios: Iterable[str | Path]
) -> pd.DataFrame:
    """A row for each training.

    Args:
        job: the trainings.
        histories: their files, in the same order.
        scenarios: files of all their scenarios as resolved.
    """
    resolved = [json.loads(Path(path).read_text(encoding="utf-8")) for path in scenarios]
    robots = {each["scenario"]: each["robot"] for each in resolved}
    return pd.DataFrame(
        [
            {"robot": robots[scenario], "scenario": scenario, "learner": learner}
            | _measured(pd.read_parquet(path), job.seed, scenario, learner)
            for (scenario, learner), path in zip(job.trainings, histories, strict=True)
        ]
    )


def _measured(history: pd.DataFrame, seed: int, scenario: str, learner: str) -> dict:
    last = history["iteration"].max()
    cells = {
        "seeds": history["seed"].nunique(),
        "iterations": last,
        "moves": history["moves"].max(),
        "refused": history.groupby("seed")["refused"].max().sum(),
    }
    for moment, iteration in (("initial", history["iteration"].min()), ("final", last)):
        then = history[history["iteration"] == iteration]
        for error in ERRORS:
            luck = generator(seed, "summary", scenario, learner, moment, error)
            cells |= bootstrap(then[error], luck).columns(f"{moment}_{error}")
    return cells
