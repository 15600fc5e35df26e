import numpy as np
import pytest

from recalib.damaged.damage import apply
from recalib.damaged.plant import Plant
from recalib.study.mapping.true_mapping import mapping_jacobians, true_commands


@pytest.fixture(scope="module")
def desired():
    return np.random.default_rng(4).uniform(-1, 1, (50, 6))


def test_the_true_commands_take_the_damaged_arm_to_the_desired_poses(controller, damaged, desired):
    commands = true_commands(controller, damaged, desired)
    achieved = Plant(controller, damaged).execute(commands[None]).achieved[0]
    assert np.allclose(achieved, desired, atol=1e-9)
    assert np.abs(commands - desired).max() > 0.1


def test_the_intact_mapping_is_the_identity(controller, robot, desired):
    intact = apply(robot, [])
    assert np.allclose(true_commands(controller, intact, desired), desired, atol=1e-9)
    assert np.allclose(mapping_jacobians(controller, intact, desired), np.eye(6), atol=1e-6)


def test_the_jacobian_is_the_slope_of_the_true_commands(controller, damaged, desired):
    jacobians = mapping_jacobians(controller, damaged, desired)
    step = 1e-4 * np.array([1, -2, 1, 2, -1, 1])
    change = true_commands(controller, damaged, desired + step) - true_commands(
        controller, damaged, desired - step
    )
    assert np.allclose(jacobians @ (2 * step), change, atol=1e-7)


def test_a_pose_out_of_reach_has_no_command(controller, damaged):
    assert np.isnan(true_commands(controller, damaged, np.array([[20.0, 0, 0, 0, 0, 0]]))).all()
