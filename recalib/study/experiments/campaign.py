"""Trainings of one learner over many seeds, on one scenario or several side by side, as the workflow runs them."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from recalib.damaged.damage import DamagedArm, apply
from recalib.damaged.fleet import Fleet
from recalib.damaged.plant import Plant
from recalib.nominal.controller import Controller
from recalib.randomness import generator
from recalib.study import scenarios


def load_scenario(path: str | Path, config: Mapping) -> tuple[Controller, DamagedArm]:
    """The controller and the damaged arm that a file of the rule `scenario` describes."""
    described = json.loads(Path(path).read_text())
    controller = scenarios.load_controller(described["robot"], config)
    return controller, apply(controller.robot, scenarios.parse_damages(described["damages"]))


def load_plant(path: str | Path, config: Mapping, runs: Sequence[int]) -> tuple[Controller, Plant]:
    """The controller and the plant that a file of the rule `scenario` describes, with the disturbances of these runs."""
    described = json.loads(Path(path).read_text())
    controller, arm = load_scenario(path, config)
    disturbances = scenarios.parse_disturbances(described["damages"])
    generators = [
        generator(config["seed"], described["scenario"], run, "disturbances") for run in runs
    ]
    return controller, Plant(controller, [arm], disturbances, generators)


def load_fleet(
    paths: Sequence[str | Path], config: Mapping, runs: Sequence[int]
) -> tuple[Controller, Fleet]:
    """As `load_plant`, for several scenarios of one robot side by side."""
    controllers, plants = zip(*(load_plant(path, config, runs) for path in paths), strict=True)
    return controllers[0], Fleet(controllers[0], plants)


def desired_poses(seed: int, scenario: str, runs: Sequence[int], iterations: int) -> np.ndarray:
    """Poses to learn from, (run, iteration, 6): the same for every learner, and fewer iterations see the first of them."""
    return np.stack(
        [generator(seed, scenario, run, "desired").uniform(-1, 1, (iterations, 6)) for run in runs]
    )


def test_poses(seed: int, scenario: str, runs: Sequence[int], count: int) -> np.ndarray:
    """Poses to measure on, (run, pose, 6), never used for learning."""
    return np.stack(
        [generator(seed, scenario, run, "tests").uniform(-1, 1, (count, 6)) for run in runs]
    )
