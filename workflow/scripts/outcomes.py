"""Put the outcomes of all universes together."""

import pandas as pd

from recalib.storage import whole
from recalib.study.evidence.claims.rigid import NONE
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    table = pd.concat(map(pd.read_csv, snakemake.input.universes), ignore_index=True)
    table["intact"] = table["intact"].clip(lower=NONE)  # below, every machine finds another error
    table.to_csv(path, index=False, float_format="%.4g")
