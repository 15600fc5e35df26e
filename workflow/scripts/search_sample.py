"""Keep all trials of the searches for one training."""

import pandas as pd

from recalib.storage import whole
from recalib.study.experiments.samples import write_sample
from recalib.study.jobs import Sample
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    trials = pd.concat(map(pd.read_csv, snakemake.input.trials), ignore_index=True)
    write_sample(path, Sample.model_validate_json(snakemake.params.job), trials)
