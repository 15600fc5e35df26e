"""Put the first and the last measurement of every training into one table, with intervals over seeds."""

import json
from pathlib import Path

import pandas as pd

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.experiments import tuned
from recalib.study.statistics import bootstrap
from workflow.scripts.job import job

ERRORS = ("position_error_cm", "orientation_error_deg")


def row(scenario: str, learner: str, path: str, config) -> dict:
    """The summary of one training's history."""
    history = pd.read_parquet(path)
    described = json.loads(
        Path(snakemake.input.scenarios[snakemake.params.scenarios.index(scenario)]).read_text()
    )
    cells = {
        "robot": described["robot"],
        "scenario": scenario,
        "learner": learner,
        "seeds": history["seed"].nunique(),
        "iterations": tuned.training(learner, config["learners"]).iterations,
        "moves": history["moves"].max(),
        "refused": history.groupby("seed")["refused"].max().sum(),
    }
    for moment, iteration in (
        ("initial", history["iteration"].min()),
        ("final", history["iteration"].max()),
    ):
        then = history[history["iteration"] == iteration]
        for error in ERRORS:
            estimate = bootstrap(
                then[error], generator(config["seed"], "summary", scenario, learner, moment, error)
            )
            cells |= {
                f"{moment}_{error}": estimate.mean,
                f"{moment}_{error}_low": estimate.low,
                f"{moment}_{error}_high": estimate.high,
            }
    return cells


with job(snakemake):
    rows = [
        row(scenario, learner, path, snakemake.config)
        for (scenario, learner), path in zip(
            snakemake.params.runs, snakemake.input.histories, strict=True
        )
    ]
    with whole(snakemake.output[0]) as path:
        pd.DataFrame(rows).to_csv(path, index=False, float_format="%.6g")
