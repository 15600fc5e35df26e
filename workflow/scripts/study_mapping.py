"""Measure section 3 on the grid of cells, and sections 4 and 5 on the true mappings."""

from recalib.storage import whole
from recalib.study.jobs import TrueMapping
from recalib.study.mapping.coupling import couplings
from recalib.study.mapping.propagation import propagation
from recalib.study.mapping.quantisation import quantisation
from workflow.scripts.job import job

with job(snakemake):
    job_ = TrueMapping.model_validate_json(snakemake.params.job)
    with whole(snakemake.output.coupling) as path:
        couplings(job_, snakemake.input.scenarios).to_parquet(path, index=False)
    with whole(snakemake.output.propagation) as path:
        propagation(job_, snakemake.input.own).to_parquet(path, index=False)
    with whole(snakemake.output.quantisation) as path:
        quantisation(job_.seed).to_parquet(path, index=False)
