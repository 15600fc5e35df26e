"""Resolve a scenario's damages on its robot, check its workspace, and measure the initial errors."""

import json
from pathlib import Path

import numpy as np

from recalib.damaged.damage import apply
from recalib.damaged.plant import Plant
from recalib.nominal.poses import orientation_error, position_error
from recalib.randomness import generator
from recalib.storage import whole
from recalib.study import scenarios
from workflow.scripts.job import job

with job(snakemake):
    config, scenario = snakemake.config, snakemake.wildcards.scenario
    name, robot = scenarios.robot_of(scenario, config)
    assignment = (
        json.loads(Path(snakemake.input.assignment).read_text())["damages"]
        if snakemake.input.assignment
        else []
    )
    damages = scenarios.resolve(config["scenarios"][name], assignment)
    controller = scenarios.load_controller(robot, config)
    arm = apply(controller.robot, scenarios.parse_damages(damages))
    workspace = controller.robot.workspace
    tests = workspace.sample(
        generator(config["seed"], scenario, "initial errors"), 1, config["paper_damage"]["poses"]
    )
    achieved, _ = Plant(controller, [arm]).achieve(tests)
    desired = workspace.to_poses(tests)
    described = {
        "scenario": scenario,
        "robot": robot,
        "damages": damages,
        "workspace": {
            "centre": workspace.centre.round(6).tolist(),
            "half_ranges_m_rad": workspace.half_ranges.round(6).tolist(),
        },
        "initial_position_error_cm": 100 * position_error(achieved, desired).mean(),
        "initial_orientation_error_deg": np.degrees(orientation_error(achieved, desired).mean()),
    }
    with whole(snakemake.output[0]) as path:
        path.write_text(json.dumps(described, indent=2) + "\n")
