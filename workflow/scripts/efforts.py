"""Train the winners of full and of rough searches for a training."""

from recalib.storage import whole
from recalib.study import jobs
from recalib.study.multiverse.efforts import efforts
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    its = jobs.Efforts.model_validate_json(snakemake.params.job)
    table = efforts(its, snakemake.input.scenario, snakemake.input.sample)
    table.insert(0, "training", snakemake.wildcards.training)
    table.to_csv(path, index=False, float_format="%.4g")
