"""Evaluate some trials of the search for one training."""

from recalib.storage import whole
from recalib.study.experiments.trials import evaluate
from recalib.study.jobs import Trials
from workflow.scripts.job import job

with job(snakemake):
    job_ = Trials.model_validate_json(snakemake.params.job)
    trials = evaluate(job_, snakemake.input.scenario, snakemake.input.earlier)
    with whole(snakemake.output[0]) as path:
        trials.to_csv(path, index=False)
