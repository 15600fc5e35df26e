"""Measure the quantisation of section 3 and the expected learning of section 6."""

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.jobs import Visits
from recalib.study.mapping.quantisation import quantisation
from recalib.study.mapping.visits import visits
from workflow.scripts.job import job

with job(snakemake):
    job_ = Visits.model_validate_json(snakemake.params.job)
    with whole(snakemake.output.visits) as path:
        visits(generator(job_.seed, "visits")).to_parquet(path, index=False)
    with whole(snakemake.output.quantisation) as path:
        quantisation(job_.seed).to_parquet(path, index=False)
