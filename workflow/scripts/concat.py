"""Put the chunks of a table together."""

import pandas as pd

from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    pd.concat(map(pd.read_parquet, snakemake.input.chunks)).to_parquet(path, index=False)
