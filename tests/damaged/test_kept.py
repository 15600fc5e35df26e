"""All that damaged robots do, as it is kept in files."""

import numpy as np
import pytest

from recalib.damaged.damage import (
    BaseShift,
    apply,
)
from recalib.damaged.disturbances import Disturbances, Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Sag
from recalib.damaged.plant import Plant
from tests.kept import plain

DISTURBED = Disturbances(Noise(2e-3, 4e-3), Repeatability(3e-3), Outliers(0.3, 0.05))


def sent(seed: int, runs: int, moves: int) -> np.ndarray:
    commands = np.random.default_rng(seed).uniform(-1, 1, (runs, moves, 6))
    commands[-1, -2] *= 11  # refused
    return commands


def generators(*seeds: int) -> list[np.random.Generator]:
    return [np.random.default_rng(seed) for seed in seeds]


def done(plant, runs: int) -> list:
    """All that comes of moves, and what is counted of them."""
    outcomes = [plant.refused, *(plant.execute(sent(seed, runs, 5)) for seed in (1, 2))]
    return [*outcomes, plant.achieve(sent(3, runs, 4)), plant.moves, plant.refused]


@pytest.mark.parametrize("disturbances", [None, DISTURBED], ids=["steady", "disturbed"])
def test_what_a_plant_does_is_as_kept(disturbances, controller, data_regression):
    damages = Sag("elbow_joint", 2e-4), BaseShift((0.03, -0.02, 0.05), (0.04, -0.07, 0.11))
    arms = [apply(controller.robot, [damage]) for damage in damages]
    luck = generators(5, 6) if disturbances else ()
    plants = [
        Plant(controller, arms, disturbances, luck),
        Plant(controller, arms[1], disturbances, generators(7, 8)),
        Plant(controller, controller.robot.arm, disturbances, generators(9, 10)),
    ]
    data_regression.check(plain([done(plant, 2) for plant in plants]))
