import numpy as np
import pytest

from recalib import BaseShift, Plant, apply


@pytest.fixture
def commands() -> np.ndarray:
    commands = np.random.default_rng(3).uniform(-0.8, 0.8, (2, 3, 6))
    commands[1, 2] = 50  # out of reach
    return commands


def test_a_robot_for_each_run_does_what_it_does_alone(controller, damaged, commands):
    moved = apply(controller.robot, [BaseShift(translate=(0.01, 0.0, 0.02))])
    together = Plant(controller, [damaged, moved]).execute(commands)
    for run, arm in enumerate((damaged, moved)):
        alone = Plant(controller, arm).execute(commands[[run]])
        assert np.array_equal(together.achieved[[run]], alone.achieved)
        assert np.array_equal(together.executed[[run]], alone.executed)


def test_moves_are_counted_with_those_that_were_refused_and_measuring_is_not(
    controller, damaged, commands
):
    plant = Plant(controller, damaged)
    poses, executed = plant.achieve(commands)
    assert plant.moves == plant.refused == 0
    home = damaged.forward(controller.robot.home[None])[0]
    assert np.argwhere(~executed).tolist() == [[1, 2]] and np.allclose(poses[1, 2], home)
    for _ in range(2):
        plant.execute(commands)
    assert plant.moves == 6 and plant.refused.tolist() == [0, 2]
