"""Train a chunk of seeds of one learner on one scenario."""

import sys

import numpy as np
import pandas as pd

from recalib.learned import flat
from recalib.storage import whole
from recalib.study.experiments import campaign, tuned
from recalib.study.progress import progress_bar
from recalib.training import measuring_grid, train
from workflow.scripts.job import job

with job(snakemake):
    config, scenario = snakemake.config, snakemake.wildcards.scenario
    plan = config["training"]
    which = tuned.training(snakemake.wildcards.learner, config["learners"])
    runs = range(*snakemake.params.seeds)
    _, plant = campaign.load_plant(snakemake.input.scenario, config, runs)
    learner = tuned.build(which, len(runs), config["learners"], config["tuned"])
    with progress_bar(f"{which} on {scenario}", which.iterations) as progress:
        history = train(
            plant,
            learner,
            campaign.desired_poses(config["seed"], scenario, runs, which.iterations),
            campaign.test_poses(config["seed"], scenario, runs, plan["tests"]),
            measuring_grid(
                which.iterations,
                plan["measure_every"],
                plan["measure_evenly"],
                plan["measurements"],
            )
            if snakemake.params.throughout
            else [0, which.iterations],
            progress,
        )
    if refused := history.refused[:, -1].sum():
        print(f"{which} on {scenario}: the controller refused {refused} moves", file=sys.stderr)
    frame = pd.DataFrame(history.columns()).rename(columns={"run": "seed"})
    frame["seed"] += runs.start
    with whole(snakemake.output.history) as path:
        frame.to_parquet(path, index=False)
    states = [flat(state) for state in learner.state()]
    with whole(snakemake.output.learned) as path:
        np.savez(path, **{name: np.stack([each[name] for each in states]) for name in states[0]})
