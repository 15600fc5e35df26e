"""Teach a learner twice: by a robot, and by the table of what the robot did."""

from recalib.storage import whole
from recalib.study.experiments.replay import replay
from recalib.study.jobs import Replay
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = Replay.model_validate_json(snakemake.params.job)
    replay(job_, snakemake.input.scenario, snakemake.input.sample).to_parquet(path, index=False)
