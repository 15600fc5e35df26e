"""Data for a page of the site that repeats the recorded training in a browser."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from recalib.damaged.damage import EncoderShift, LinkShortening
from recalib.nominal.chain import Chain
from replication.config.damages import damages_among
from replication.config.study import Study
from replication.config.switches import IMPROVED
from replication.recording.recorded import recorded_history, typical_seed
from replication.scenarios.plants import Resolved, nominal_robot
from replication.training.plan import leading
from replication.training.poses import Stream
from replication.training.tuned import Tuned, rules_of

DIGITS = 12  # decimals of placements: machines round sines differently


def script(study: Study, scenario: Path, settings: Sequence[Path], history: Path) -> str:
    """A script that defines STUDY: robot, damage, learner and poses; lengths in m, angles in rad.

    `scenario` is the study's main scenario, with short links and shifted encoders; `history` is
    that of the improved system in this scenario.
    """
    resolved, iterations = Resolved.read(scenario), leading(study).iterations
    seed, tests = typical_seed(recorded_history(study, history)), study.training.tests
    poses = Stream.SCENARIO.draw(study.seed, [seed], iterations, tests, scenario=resolved.scenario)
    robot, links = nominal_robot(resolved.nominal), resolved.nominal.robot.links
    amounts = dict.fromkeys((*links, *robot.joints), 0.0)
    for damage in damages_among(resolved.damages):
        match damage:
            case LinkShortening():
                amounts[damage.link] = damage.shorten
            case EncoderShift():
                amounts[damage.encoder] = damage.shift
    rules = rules_of(study.every_learner[IMPROVED])
    placements = Chain.of(robot.arm).placements[0].reshape(-1, 12)
    kinematics = {
        "links": [[link, robot.links[link]] for link in links],  # index of the placement at its end
        "joints": [*robot.joints],
        "placements": np.round(placements, DIGITS).tolist(),
        "home": robot.home.tolist(),
        "lower": robot.lower.tolist(),
        "upper": robot.upper.tolist(),
        "half_ranges": robot.workspace.half_ranges.tolist(),
    }
    described = {
        "robot": kinematics,
        "damage": [*amounts.values()],
        "iterations": iterations,
        "every": study.training.measure_every,
        "supernet": rules.supernet,
        "subnet": rules.subnet,
        "schedule": Tuned(study, settings).learner(IMPROVED, iterations, 1).settings()["by_run"][0],
        "desired": poses.desired[0].tolist(),
        "tests": poses.tests[0].tolist(),
    }
    return f"// Written by the pipeline: seed {seed}.\nconst STUDY = {json.dumps(described)};\n"
