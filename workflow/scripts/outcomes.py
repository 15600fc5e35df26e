"""Put the outcomes of all universes together."""

import pandas as pd

from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    tables = map(pd.read_csv, snakemake.input.universes)
    pd.concat(tables, ignore_index=True).to_csv(path, index=False)
