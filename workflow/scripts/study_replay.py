"""Teach a learner twice: by a robot, and by the table of the commands that it sent and the poses that it was shown."""

import numpy as np
import pandas as pd

from recalib.damaged.plant import Plant
from recalib.learned import flat
from recalib.storage import whole
from recalib.study.experiments import campaign, tuned
from workflow.scripts.job import job

with job(snakemake):
    config = snakemake.config
    controller, arm = campaign.load_scenario(snakemake.input.scenario, config)
    which = tuned.training(snakemake.params.name, config["learners"])
    desired = campaign.desired_poses(config["seed"], "replay", [0], which.iterations)
    plant, table = Plant(controller, [arm]), {}

    def by_robot(commands):
        """Ask the robot, and write down what it did."""
        table[commands.tobytes()] = plant.execute(commands)
        return table[commands.tobytes()]

    def by_table(commands):
        """Look it up; a command that was never sent is an error."""
        return table[commands.tobytes()]

    learned = []
    for execute in (by_robot, by_table):
        learner = tuned.build(which, 1, config["learners"], config["tuned"])
        for iteration in range(which.iterations):
            learner.learn(desired[:, iteration], execute, iteration / which.iterations)
        learned.append(flat(learner.state()[0]))
    rows = [
        {"array": name, "difference": np.abs(learned[1][name] - values).max()}
        for name, values in learned[0].items()
    ]
    with whole(snakemake.output[0]) as path:
        pd.DataFrame(rows).to_parquet(path, index=False)
