"""Put tables of the campaign together, with a digest of the design if they follow it."""

import pandas as pd

from recalib.storage import whole
from recalib.study.measured import NONE
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    table = pd.concat(map(pd.read_csv, snakemake.input.chunks), ignore_index=True)
    if "intact" in table:  # below, every machine finds another error
        table["intact"] = table["intact"].clip(lower=NONE)
    if snakemake.params.design:
        table.insert(0, "design", snakemake.params.design)
    table.to_csv(path, index=False, float_format="%.6g")
