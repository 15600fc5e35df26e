"""Put the benchmark together: errors after so many moves, and the moves that it takes to reach each threshold."""

import numpy as np
import pandas as pd

from recalib.benchmark import BLACK_BOX, moves_to_reach
from recalib.evidence import ERRORS
from recalib.peers import NEEDS
from recalib.randomness import generator
from recalib.statistics import bootstrap
from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    config = snakemake.config
    history = pd.concat(map(pd.read_parquet, snakemake.input.histories))
    rows, reached, seconds = [], [], []
    for (scenario, learner), own in history.groupby(["scenario", "learner"], sort=False):
        for moves, measured in own.groupby("moves"):
            row = {"scenario": scenario, "learner": learner, "moves": moves, "seeds": len(measured)}
            for error in ERRORS:
                estimate = bootstrap(measured[error], generator(config["seed"], scenario, learner, moves, error))
                row |= {error: estimate.mean, f"{error}_low": estimate.low, f"{error}_high": estimate.high}
            rows.append(row)
        seconds.append({"scenario": scenario, "learner": learner, "seconds_per_move": own["seconds_per_move"].iloc[0]})
        for error in ERRORS:
            for threshold in config["benchmark"]["thresholds"]:
                moves = moves_to_reach(own, error, threshold)
                low, median, high = np.quantile(moves, [0.05, 0.5, 0.95], method="nearest")
                cells = {"scenario": scenario, "learner": learner, "error": error, "threshold": threshold}
                reached.append(cells | {"moves": median, "low": low, "high": high, "needs": NEEDS.get(learner, BLACK_BOX)})
    # Seconds differ from run to run: in a file of their own, the others stay what the configuration makes them.
    for table, target in zip((rows, reached, seconds), snakemake.output, strict=True):
        with whole(target) as path:
            pd.DataFrame(table).to_csv(path, index=False, float_format="%.6g")
