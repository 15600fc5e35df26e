"""The maps of 1996 choose their poses, so they learn on a twin of the real arm, identified from all recorded poses."""

import numpy as np
import pandas as pd

from recalib.damaged.plant import Plant
from recalib.nominal.controller import Controller
from recalib.storage import whole
from recalib.study.experiments import campaign, tuned
from recalib.study.experiments.recorded import calibrate_hybrid, read_recording, with_tool_point
from recalib.study.scenarios import robot_of_entry
from recalib.training import train
from workflow.scripts.job import job

with job(snakemake):
    config, name = snakemake.config, snakemake.wildcards.learner
    plan = config["real"]
    robot = with_tool_point(robot_of_entry(plan["robot"], config["robots"][plan["robot"]]))
    twin = calibrate_hybrid(robot.arm, read_recording(snakemake.input.fit))
    which = tuned.training(name, config["learners"])
    runs = range(plan["subsets"])
    history = train(
        Plant(Controller(robot, config["controller"]["greatest_condition"]), [twin]),
        tuned.build(which, len(runs), config["learners"], config["tuned"]),
        campaign.desired_poses(config["seed"], "twin", runs, which.iterations),
        campaign.test_poses(config["seed"], "twin", runs, config["training"]["tests"]),
        sorted(
            {poses // 2 for poses in plan["poses"] if poses // 2 <= which.iterations}
            | {which.iterations}
        ),
    )
    frame = pd.DataFrame(
        {
            "learner": f"{name} on a twin",
            "poses": np.tile(history.moves, len(runs)),
            "subset": np.repeat(runs, len(history.moves)),
            "position_error_mm": 1e3 * history.position[..., 0].ravel(),
        }
    )
    with whole(snakemake.output[0]) as path:
        frame.to_csv(path, index=False)
