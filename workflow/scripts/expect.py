"""Propose bands for the check from the summary of this run."""

import pandas as pd

from recalib.storage import whole
from recalib.study.evidence.checks import expect
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    expect(pd.read_csv(snakemake.input.summary)).to_csv(path, index=False, float_format="%.4g")
