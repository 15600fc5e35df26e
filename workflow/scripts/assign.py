"""Enumerate every assignment of the paper's damage to a robot and keep the one nearest to the published errors."""

import json

import pandas as pd

from recalib import quantities
from recalib.randomness import generator
from recalib.storage import whole
from recalib.study import scenarios
from recalib.study.assignments import damages_of, distance_to, enumerate_assignments
from workflow.scripts.job import job

with job(snakemake):
    config, robot = snakemake.config, snakemake.wildcards.robot
    paper = config["paper_damage"]
    controller = scenarios.load_controller(robot, config)
    poses = controller.robot.workspace.sample(
        generator(config["seed"], "assignments"), paper["poses"]
    )
    table = enumerate_assignments(
        controller,
        config["robots"][robot]["links"],
        [quantities.length(amount) for amount in paper["shorten"]],
        [quantities.angle(amount) for amount in paper["shift"]],
        poses,
    )
    table["distance"] = distance_to(table, **paper["published"])
    nearest: pd.Series = table.loc[table["distance"].idxmin()]
    assignment = {
        "robot": robot,
        "assignments": len(table),
        "damages": [scenarios.describe_damage(damage) for damage in damages_of(nearest)],
        "distance": nearest["distance"],
        "within_5_percent": int((table["distance"] <= 0.05).sum()),
    }
    with whole(snakemake.output.table) as path:
        table.to_parquet(path, index=False)
    with whole(snakemake.output.assignment) as path:
        path.write_text(json.dumps(assignment, indent=2) + "\n")
