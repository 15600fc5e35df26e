"""Train a learner on some other damages, each a robot of its own."""

from recalib.storage import whole
from recalib.study.experiments.ensemble import train_draws
from recalib.study.jobs import Draws
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    table = train_draws(Draws.model_validate_json(snakemake.params.job), snakemake.input.sample)
    table.to_parquet(path, index=False)
