"""Put the chunks of a training together."""

import numpy as np
import pandas as pd

from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    with whole(snakemake.output.history) as path:
        pd.concat(map(pd.read_parquet, snakemake.input.histories)).to_parquet(path, index=False)
    chunks = [np.load(chunk) for chunk in snakemake.input.learned]
    with whole(snakemake.output.learned) as path:
        np.savez(
            path, **{name: np.concatenate([chunk[name] for chunk in chunks]) for name in chunks[0]}
        )
