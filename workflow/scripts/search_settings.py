"""Keep the whole sample of the search, and the best trial of each training."""

import pandas as pd
import yaml

from recalib.storage import whole
from recalib.study.experiments import search
from workflow.scripts.job import job

with job(snakemake):
    sample = pd.concat(map(pd.read_csv, snakemake.input), ignore_index=True)
    settings = {}
    for name, trials in sample.groupby("training", sort=False):
        best = trials.loc[search.score(trials).idxmin()].drop(["training", "round"]).dropna()
        settings[name] = best.to_dict() | {"trials": len(trials)}
    with whole(snakemake.output.settings) as path:
        text = yaml.safe_dump(settings, sort_keys=False)
        path.write_text(
            f"# Written by `snakemake --cores 2 tune`: the best trial of the search for each training.\n{text}"
        )
    with whole(snakemake.output.sample) as path:
        sample.to_csv(path, index=False)
