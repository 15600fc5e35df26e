"""Try the model of the campaign in worlds whose truth is known."""

from recalib.storage import whole
from recalib.study.multiverse.power import power
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    table = power(snakemake.params.setups, snakemake.params.replicates)
    table.to_csv(path, index=False, float_format="%.4g")
