"""Evaluate a chunk of the search's trials for one training, on seeds and poses that nothing else uses."""

import numpy as np
import pandas as pd

from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.storage import whole
from recalib.study.experiments import campaign, search, tuned
from recalib.training import train
from workflow.scripts.job import job

with job(snakemake):
    config = snakemake.config
    plan = config["search"]
    which = tuned.training(snakemake.wildcards.learner, config["learners"])
    rules = tuned.rules(config["learners"][which.name])
    best = None
    if snakemake.input.earlier:
        earlier = pd.concat(map(pd.read_csv, snakemake.input.earlier), ignore_index=True)
        best = earlier.loc[search.score(earlier).idxmin()]
    round_, (start, stop) = int(snakemake.wildcards.round), snakemake.params.trials
    trials = search.draw(rules, plan["ranges"], plan["trials"], plan["seed"] + round_, best)[
        start:stop
    ]
    controller, arm = campaign.load_scenario(snakemake.input.scenario, config)
    seeds, scope = range(plan["seeds"]), f"search on {plan['scenario']}"
    desired = campaign.desired_poses(plan["seed"], scope, seeds, which.iterations)
    tests = campaign.test_poses(plan["seed"], scope, seeds, config["training"]["tests"])
    learner = HierarchicalLearner(
        len(trials) * len(seeds), rules, search.schedule(trials, rules, len(seeds))
    )
    history = train(
        Plant(controller, [arm]),
        learner,
        np.tile(desired, (len(trials), 1, 1)),
        np.tile(tests, (len(trials), 1, 1)),
        [which.iterations],
    )
    # A trial's errors are geometric means over seeds and kept to four digits: the file is the same on every machine.
    for column, errors in (
        ("position_error_cm", 100 * history.position),
        ("orientation_error_deg", np.degrees(history.orientation)),
    ):
        trials[column] = np.exp(
            np.log(errors[:, -1, 0]).reshape(len(trials), len(seeds)).mean(axis=1)
        )
        trials[column] = trials[column].map("{:.4g}".format).astype(float)
    trials.insert(0, "training", str(which))
    trials.insert(1, "round", round_)
    with whole(snakemake.output[0]) as path:
        trials.to_csv(path, index=False)
