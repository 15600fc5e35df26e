"""Compare the final errors with their bands; fail where one is outside."""

import pandas as pd

from recalib.storage import whole
from recalib.study.evidence.checks import CheckFailed, check
from workflow.scripts.job import job

with job(snakemake):
    table = check(pd.read_csv(snakemake.input.summary), pd.read_csv(snakemake.input.expected))
    print(table.to_string(index=False, float_format="{:.4g}".format))
    if not table["ok"].all():
        raise CheckFailed(table[~table["ok"]])
    with whole(snakemake.output[0]) as path:
        text = table.to_string(index=False, float_format="{:.4g}".format)
        path.write_text(text + "\n", encoding="utf-8")
