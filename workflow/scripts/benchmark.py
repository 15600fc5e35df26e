"""Let one learner work through scenarios of the benchmark, and measure it at every budget of moves."""

import numpy as np
import pandas as pd

from recalib.storage import whole
from recalib.study.experiments import campaign
from recalib.study.experiments.benchmark import Timed, entrant
from recalib.study.progress import progress_bar
from recalib.training import train
from workflow.scripts.job import job

with job(snakemake):
    config, name = snakemake.config, snakemake.wildcards.learner
    scenarios, runs = snakemake.params.scenarios, range(config["benchmark"]["seeds"])
    which = entrant(name, config)
    controller, fleet = campaign.load_fleet(snakemake.input.scenarios, config, runs)
    learner = Timed(which.make(len(scenarios) * len(runs), controller))
    desired, tests = (
        np.concatenate([poses(config["seed"], scenario, runs, count) for scenario in scenarios])
        for poses, count in (
            (campaign.desired_poses, which.iterations),
            (campaign.test_poses, config["training"]["tests"]),
        )
    )
    budgets = which.measure_at([*config["benchmark"]["moves"], *config["benchmark"]["longer"]])
    with progress_bar(f"{name} on {', '.join(scenarios)}", which.iterations) as progress:
        frame = pd.DataFrame(train(fleet, learner, desired, tests, budgets, progress).columns())
    frame = frame.drop(columns="run").assign(
        scenario=np.array(scenarios)[frame["run"] // len(runs)],
        seed=frame["run"] % len(runs),
        learner=name,
        seconds_per_move=learner.seconds
        / (len(desired) * which.iterations * which.moves_per_iteration),
    )
    with whole(snakemake.output[0]) as path:
        frame.to_parquet(path, index=False)
