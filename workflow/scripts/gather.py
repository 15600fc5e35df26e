"""Put the chunks of a training together."""

import pandas as pd

from recalib.learned import join
from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    with whole(snakemake.output.history) as path:
        pd.concat(map(pd.read_parquet, snakemake.input.histories)).to_parquet(path, index=False)
    join(snakemake.output.learned, snakemake.input.learned)
