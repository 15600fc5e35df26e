"""Train some seeds of one learner on one scenario."""

import pyarrow as pa
import pyarrow.parquet as pq

from recalib.learned import save
from recalib.storage import whole
from recalib.study.experiments.campaign import train_seeds
from recalib.study.jobs import Training
from workflow.scripts.job import job

with job(snakemake):
    job_ = Training.model_validate_json(snakemake.params.job)
    history, learner, robot = train_seeds(job_, snakemake.input.scenario, snakemake.input.sample)
    with whole(snakemake.output.history) as path:
        pq.write_table(pa.table(history), path)
    save(snakemake.output.learned, learner, robot)
