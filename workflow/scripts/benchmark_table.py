"""Put the benchmark together: errors after so many moves, and the moves that it takes to reach each threshold."""

from itertools import product

import numpy as np
import pandas as pd

from recalib.learners.peers import NEEDS
from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.evidence.results import ERRORS
from recalib.study.experiments.benchmark import BLACK_BOX, moves_to_reach
from recalib.study.statistics import bootstrap
from workflow.scripts.job import job

with job(snakemake):
    config = snakemake.config
    plan = config["benchmark"]
    history = pd.concat(map(pd.read_parquet, snakemake.input.histories))
    groups = history.groupby(["scenario", "learner"])
    rows, reached = [], []
    for scenario, learner in product(plan["scenarios"], plan["learners"]):
        own = groups.get_group((scenario, learner))
        for moves, measured in own.groupby("moves"):
            row = {"scenario": scenario, "learner": learner, "moves": moves, "seeds": len(measured)}
            for error in ERRORS:
                estimate = bootstrap(
                    measured[error], generator(config["seed"], scenario, learner, moves, error)
                )
                row |= {
                    error: estimate.mean,
                    f"{error}_low": estimate.low,
                    f"{error}_high": estimate.high,
                }
            rows.append(row)
        for error in ERRORS:
            for threshold in plan["thresholds"]:
                moves = moves_to_reach(own, error, threshold)
                low, median, high = np.quantile(moves, [0.05, 0.5, 0.95], method="nearest")
                cells = {
                    "scenario": scenario,
                    "learner": learner,
                    "error": error,
                    "threshold": threshold,
                }
                reached.append(
                    cells
                    | {
                        "moves": median,
                        "low": low,
                        "high": high,
                        "needs": NEEDS.get(learner, BLACK_BOX),
                    }
                )
    # Seconds differ from run to run: in a file of their own, the others stay what the configuration makes them.
    seconds = history.groupby("learner", sort=False)["seconds_per_move"].mean().reset_index()
    for table, target in zip((rows, reached, seconds), snakemake.output, strict=True):
        with whole(target) as path:
            pd.DataFrame(table).to_csv(path, index=False, float_format="%.6g")
