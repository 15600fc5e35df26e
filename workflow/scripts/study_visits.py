"""Measure the expected learning of section 6 by Monte Carlo."""

import numpy as np

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.mapping.visits import visits
from workflow.scripts.job import job

with job(snakemake):
    widths, distances = (
        np.array([0.1, 0.15, 0.2, 0.3, 0.5, 1.0]),
        np.array([0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0]),
    )
    with whole(snakemake.output[0]) as path:
        visits(widths, distances, 3, generator(snakemake.config["seed"], "visits")).to_parquet(
            path, index=False
        )
