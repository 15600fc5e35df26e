import numpy as np
import pytest

from recalib.damaged.damage import BaseShift, apply
from recalib.damaged.disturbances import Disturbances, Noise, Repeatability
from recalib.damaged.fleet import Fleet
from recalib.damaged.plant import Plant


@pytest.fixture
def plants(controller, damaged):
    def make():
        noisy = Disturbances(Noise(1e-3, 0.0), Repeatability(1e-3))
        moved = apply(controller.robot, [BaseShift(translation=(0.01, 0.0, 0.02))])
        return [
            Plant(controller, damaged),
            Plant(controller, moved, noisy, [np.random.default_rng(seed) for seed in (1, 2)]),
        ]

    return make


@pytest.fixture
def commands() -> np.ndarray:
    commands = np.random.default_rng(3).uniform(-0.8, 0.8, (4, 3, 6))
    commands[1, 2] = commands[3, 0] = 50  # out of reach
    return commands


def test_a_fleet_does_what_its_plants_do_one_by_one(controller, plants, commands):
    fleet, alone = Fleet(controller, plants()), plants()
    for _ in range(2):
        together = fleet.execute(commands)
        apart = [
            plant.execute(share) for plant, share in zip(alone, np.split(commands, 2), strict=True)
        ]
        assert np.array_equal(
            together.achieved, np.concatenate([outcome.achieved for outcome in apart])
        )
        assert np.array_equal(
            together.executed, np.concatenate([outcome.executed for outcome in apart])
        )
    assert fleet.moves == 6 == alone[0].moves
    assert fleet.refused.tolist() == [0, 2, 0, 2] == [*alone[0].refused, *alone[1].refused]


def test_a_robot_for_each_run_does_what_it_does_alone(controller, damaged, commands):
    moved = apply(controller.robot, [BaseShift(translation=(0.01, 0.0, 0.02))])
    together = Plant(controller, [damaged, moved]).execute(commands[:2])
    for run, arm in enumerate((damaged, moved)):
        alone = Plant(controller, arm).execute(commands[[run]])
        assert np.array_equal(together.achieved[[run]], alone.achieved)
        assert np.array_equal(together.executed[[run]], alone.executed)


def test_measuring_a_fleet_counts_no_moves(controller, plants, commands):
    fleet = Fleet(controller, plants())
    poses, executed = fleet.achieve(commands)
    assert np.array_equal(poses[:2], plants()[0].achieve(commands[:2])[0])
    assert np.sum(~executed) == 2
    assert fleet.moves == fleet.refused == 0
