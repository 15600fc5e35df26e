"""Put the results on the real arm together."""

import pandas as pd

from recalib.storage import whole
from recalib.study.evidence.real import real_errors
from recalib.study.jobs import RealTable
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = RealTable.model_validate_json(snakemake.params.job)
    runs = pd.concat(map(pd.read_csv, snakemake.input.runs))
    real_errors(job_, runs).to_csv(path, index=False, float_format="%.5g")
