"""What a browser needs to repeat the run that is recorded: the site has a page that does."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.damaged.damage import EncoderShift, LinkShortening
from recalib.nominal.chain import Chain
from recalib.nominal.robots import Robot
from replication.config.damages import damages_among
from replication.config.study import LearnerSettings, Measuring
from replication.judgement.intervals import typical
from replication.scenarios.plants import Resolved, nominal_robot
from replication.training.measured import errors_of
from replication.training.poses import Stream
from replication.training.settings import build_tuned

DIGITS = 12  # of placements: machines differ in how they round sines


def script(
    scenario: Path,
    sample: Path,
    history: Path,
    learner: LearnerSettings,
    measuring: Measuring,
    seed: int,
) -> str:
    """A script that defines STUDY: robot, damage, learner and poses; lengths in m, angles in rad.

    Args:
        history: file of its training.
    """
    resolved, errors = Resolved.read(scenario), errors_of(pd.read_parquet(history))
    search = typical(errors)
    run = int(search * errors.shape[1])  # the first one of that search
    poses = Stream.SCENARIO.draw(
        seed, [run], learner.iterations, measuring.tests, scenario=resolved.scenario
    )
    robot, links = nominal_robot(resolved.nominal), resolved.nominal.robot.links
    amounts = dict.fromkeys((*links, *robot.joints), 0.0)
    for damage in damages_among(resolved.damages):
        match damage:
            case LinkShortening():
                amounts[damage.link] = damage.shorten
            case EncoderShift():
                amounts[damage.encoder] = damage.shift
    study = {
        "robot": _described(robot, links),
        "damage": [*amounts.values()],
        "run": run,
        "iterations": learner.iterations,
        "every": measuring.measure_every,
        "supernet": learner.supernet,
        "subnet": learner.subnet,
        "schedule": build_tuned(learner, sample, [search + 1]).settings()["by_run"][0],
        "desired": poses.desired[0].tolist(),
        "tests": poses.tests[0].tolist(),
    }
    return f"// Written by the pipeline: run {run}.\nconst STUDY = {json.dumps(study)};\n"


def _described(robot: Robot, links: tuple[str, ...]) -> dict[str, list]:
    """Its kinematics, and each of these links with the placement at its end."""
    placements = Chain.of(robot.arm).placements
    return {
        "links": [[link, robot.links[link]] for link in links],
        "joints": [*robot.joints],
        "placements": np.round(placements[0].reshape(-1, 12), DIGITS).tolist(),
        "home": robot.home.tolist(),
        "lower": robot.lower.tolist(),
        "upper": robot.upper.tolist(),
        "half_ranges": robot.workspace.half_ranges.tolist(),
    }
