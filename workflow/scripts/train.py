"""Train some seeds of one learner on one scenario."""

from recalib.learned import save
from recalib.storage import whole
from recalib.study.experiments.campaign import train_seeds
from recalib.study.jobs import Training
from workflow.scripts.job import job

with job(snakemake):
    job_ = Training.model_validate_json(snakemake.params.job)
    history, learner, robot = train_seeds(job_, snakemake.input.scenario, snakemake.input.sample)
    with whole(snakemake.output.history) as path:
        history.to_parquet(path, index=False)
    save(snakemake.output.learned, learner, robot)
