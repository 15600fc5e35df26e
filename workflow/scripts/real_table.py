"""Put the results on the real arm together: a row for each learner and number of poses, with the interval over subsets."""

import pandas as pd

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.statistics import bootstrap
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    runs = pd.concat(map(pd.read_csv, snakemake.input.runs))
    rows = []
    for (learner, poses), own in runs.groupby(["learner", "poses"], sort=False):
        estimate = bootstrap(
            own["position_error_mm"], generator(snakemake.config["seed"], "real", learner, poses)
        )
        columns = ("position_error_mm", "position_error_mm_low", "position_error_mm_high")
        rows.append(
            {"learner": learner, "poses": poses, "subsets": len(own)}
            | dict(zip(columns, estimate, strict=True))
        )
    pd.DataFrame(rows).to_csv(path, index=False, float_format="%.5g")
