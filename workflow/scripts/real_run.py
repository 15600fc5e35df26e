"""Let one learner learn from random subsets of the recorded poses, and test it on the recorded test poses."""

import pandas as pd

from recalib.randomness import generator
from recalib.storage import whole
from recalib.study.experiments.recorded import read_recording, remaining_errors, with_tool_point
from recalib.study.scenarios import robot_of_entry
from workflow.scripts.job import job

with job(snakemake):
    config, learner = snakemake.config, snakemake.wildcards.learner
    plan = config["real"]
    robot = with_tool_point(robot_of_entry(plan["robot"], config["robots"][plan["robot"]]))
    known, tests = read_recording(snakemake.input.fit), read_recording(snakemake.input.test)
    rows = []
    for poses in plan["poses"]:
        # With all of them there is one subset only; what learns nothing needs one, too.
        subsets = 1 if poses >= len(known) or learner == "uncorrected" else plan["subsets"]
        for subset in range(subsets):
            chosen = generator(config["seed"], "real", poses, subset).permutation(len(known))[
                :poses
            ]
            errors = remaining_errors(learner, robot.arm, known[chosen], tests)
            rows.append(
                {
                    "learner": learner,
                    "poses": poses,
                    "subset": subset,
                    "position_error_mm": 1e3 * errors.mean(),
                }
            )
    with whole(snakemake.output[0]) as path:
        pd.DataFrame(rows).to_csv(path, index=False)
