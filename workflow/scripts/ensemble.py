"""Train a learner on many assignments of the paper's damage, each a robot of its own, at several scales of the damage."""

from itertools import islice

import numpy as np
import pandas as pd

from recalib.damaged.damage import EncoderShift, apply
from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.randomness import generator
from recalib.storage import whole
from recalib.study import scenarios
from recalib.study.assignments import damages_of
from recalib.study.experiments import campaign, tuned
from recalib.training import train
from workflow.scripts.job import job


def scaled(damage, scale):
    """The damage `scale` times as large."""
    if isinstance(damage, EncoderShift):
        return EncoderShift(damage.joint, damage.angle * scale)
    return type(damage)(damage.link, damage.length * scale)


def feasible(robot, damages, scale):
    """Whether the links are long enough."""
    try:
        apply(robot, [scaled(damage, scale) for damage in damages])
    except InvalidSetting:
        return False
    return True


with job(snakemake):
    config, plan, (first, last) = snakemake.config, snakemake.params.plan, snakemake.params.robots
    which = tuned.training(snakemake.wildcards.learner, config["learners"])
    controller = scenarios.load_controller(config["robot"], config)
    table = pd.read_parquet(snakemake.input.table)
    order = generator(config["seed"], "ensemble", snakemake.wildcards.series).permutation(
        len(table)
    )
    greatest = max(plan["scales"])
    drawn = (damages_of(table.iloc[index]) for index in order)
    chosen = list(
        islice(
            (damages for damages in drawn if feasible(controller.robot, damages, greatest)),
            first,
            last,
        )
    )
    cases = [(index, scale) for index in range(len(chosen)) for scale in plan["scales"]]
    arms = [
        apply(controller.robot, [scaled(damage, scale) for damage in chosen[index]])
        for index, scale in cases
    ]
    runs = [first + index for index, _ in cases]
    learner = tuned.build(which, len(cases), config["learners"], config["tuned"])
    history = train(
        Plant(controller, arms),
        learner,
        campaign.desired_poses(config["seed"], "ensemble", runs, which.iterations),
        campaign.test_poses(config["seed"], "ensemble", runs, config["training"]["tests"]),
        [0, which.iterations],
    )
    frame = pd.DataFrame(
        {"robot": runs, "scale": [scale for _, scale in cases], "refused": history.refused[:, -1]}
    )
    for moment, when in (("initial", 0), ("final", -1)):
        frame[f"{moment}_position_error_cm"] = 100 * history.position[:, when, 0]
        frame[f"{moment}_orientation_error_deg"] = np.degrees(history.orientation[:, when, 0])
    with whole(snakemake.output[0]) as path:
        frame.to_parquet(path, index=False)
