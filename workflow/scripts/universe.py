"""Measure one universe."""

from recalib.storage import whole
from recalib.study.multiverse.measuring import measure
from recalib.study.multiverse.universe import Universe
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    import pandas as pd  # a quarter of a second: no start waits for it

    rows = measure(Universe.model_validate_json(snakemake.params.job))
    pd.DataFrame(rows).to_csv(path, index=False, float_format="%.6g")
