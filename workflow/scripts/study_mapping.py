"""Measure sections 4 and 5 on the true mappings: the coupling of positions and orientations, and E_clas against E_upd."""

import json
from functools import partial
from pathlib import Path

import pandas as pd

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.randomness import generator
from recalib.storage import whole
from recalib.study import scenarios
from recalib.study.experiments import campaign
from recalib.study.mapping.coupling import coupling
from recalib.study.mapping.propagation import ball, propagation_errors
from recalib.study.mapping.true_mapping import mapping_jacobians, true_commands
from workflow.scripts.job import job


def scaled(damages, scale):
    """The paper's damage made smaller or drastic. Links cannot lose more than they have, so they stop growing at once."""
    links = [
        LinkShortening(each.link, each.length * min(scale, 1))
        for each in damages
        if isinstance(each, LinkShortening)
    ]
    return [
        *links,
        *(
            EncoderShift(each.joint, each.angle * scale)
            for each in damages
            if isinstance(each, EncoderShift)
        ),
    ]


with job(snakemake):
    config, plan = snakemake.config, snakemake.config["studies"]
    rng = partial(generator, config["seed"], "study")
    frames = []
    for path in snakemake.input.scenarios:
        controller, arm = campaign.load_scenario(path, config)
        desired = controller.robot.workspace.sample(rng("coupling"), plan["poses"])
        frames.append(coupling(controller, arm, desired).assign(scenario=Path(path).stem))
    with whole(snakemake.output.coupling) as path:
        pd.concat(frames).to_parquet(path, index=False)

    damages = [
        scenarios.parse_damage(each)
        for each in json.loads(Path(snakemake.input.paper).read_text())["damages"]
    ]
    robot = controller.robot
    offsets = ball(rng("ball"), plan["points"], 6, plan["radius"])
    centres = robot.workspace.sample(rng("centres"), plan["balls"]) * (1 - plan["radius"])
    starts = {"intact": apply(robot, []), "damaged": apply(robot, damages)}
    rows = []
    for scale in plan["scales"]:
        for start, old in starts.items():
            # From the intact robot, the paper's damage; from the damaged one, as much again on top of it.
            new = apply(
                robot,
                scaled(damages, scale)
                if start == "intact"
                else [*damages, *scaled(damages, scale)],
            )
            for kind, mapping in (("theta", true_commands), ("jacobian", mapping_jacobians)):
                pair = [partial(mapping, controller, which) for which in (old, new)]
                errors = [propagation_errors(*pair, centre, offsets) for centre in centres]
                rows += [
                    {"scale": scale, "start": start, "kind": kind, "classic": c, "updated": u}
                    for c, u in errors
                ]
    with whole(snakemake.output.propagation) as path:
        pd.DataFrame(rows).to_parquet(path, index=False)
