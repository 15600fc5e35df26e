"""Measure the expected learning of section 6 by Monte Carlo."""

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.jobs import Visits
from recalib.study.mapping.visits import visits
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = Visits.model_validate_json(snakemake.params.job)
    visits(generator(job_.seed, "visits")).to_parquet(path, index=False)
