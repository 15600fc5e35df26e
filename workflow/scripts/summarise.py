"""Put the first and the last errors of every training into one table."""

from recalib.storage import whole
from recalib.study.evidence.summary import summarise
from recalib.study.jobs import Summary
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = Summary.model_validate_json(snakemake.params.job)
    table = summarise(job_, snakemake.input.histories, snakemake.input.scenarios)
    table.to_csv(path, index=False, float_format="%.6g")
