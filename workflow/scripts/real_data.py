"""Bring one table of the real arm, from a file or from its public address."""

from recalib.storage import whole
from recalib.study.experiments.tracker import fetch
from recalib.study.jobs import RealData
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    fetch(RealData.model_validate_json(snakemake.params.job), path)
