"""Put the benchmark together."""

import pandas as pd

from recalib.storage import whole
from recalib.study.evidence.benchmark import errors, reached, seconds
from recalib.study.jobs import BenchmarkTable
from workflow.scripts.job import job

with job(snakemake):
    job_ = BenchmarkTable.model_validate_json(snakemake.params.job)
    history = pd.concat(map(pd.read_parquet, snakemake.input.histories))
    with whole(snakemake.output.table) as path:
        errors(job_, history).to_csv(path, index=False, float_format="%.6g")
    with whole(snakemake.output.reached) as path:
        reached(job_, history).to_csv(path, index=False, float_format="%.6g")
    with whole(snakemake.output.seconds) as path:
        seconds(history).to_csv(path, index=False, float_format="%.6g")
