"""An arm of seven joints behind the nominal controller: poses determine joint angles there, too."""

import numpy as np
import pytest

from recalib.errors import UnsuitableRobot
from recalib.nominal.controller import Controller
from recalib.nominal.poses import position_error
from recalib.nominal.robots import load_robot
from tests.arms import SCARA, panda

SIDES = [0.2, 0.24, 0.2], np.radians([40, 40, 40])


@pytest.fixture(scope="module")
def controller() -> Controller:
    return Controller(panda())


def test_the_posture_changes_smoothly_and_hardly_without_moving_the_tool(controller):
    path = np.linspace(-1, 1, 401)[:, None] * np.array([1, -1, 1, -1, 1, -1])
    angles = controller.targets(path[None]).angles[0]
    steps = np.diff(angles, axis=0)
    assert np.abs(np.diff(steps, axis=0)).max() < 2e-3
    _, jacobians = controller.robot.arm.forward_and_jacobian(angles[:-1])
    idle = np.array([np.linalg.svd(jacobian)[2][-1] for jacobian in jacobians])
    assert np.abs((idle * steps).sum(axis=1)).max() < 0.3 * np.linalg.norm(steps, axis=1).max()


def test_commands_are_found_for_joint_angles_that_the_controller_would_not_choose(controller):
    desired = controller.robot.workspace.sample(np.random.default_rng(3), 1, 30)
    tilt = np.radians([1, -2, 4, 1, -3, 2, 1])  # what an arm with shifted encoders would need
    poses = controller.robot.workspace.to_poses(desired)[0]

    def needed(angles):
        found, residuals = controller._chain.solve(poses, angles[0] + tilt)
        assert residuals.max() < 1e-9
        return (found - tilt)[None]

    commands = controller.commands_for(desired, needed)
    standing = controller.targets(commands).angles[0] + tilt
    reached = controller.robot.arm.forward(standing)
    assert position_error(reached, poses).max() < 1e-7


def test_a_workspace_needs_six_joints(tmp_path):
    (path := tmp_path / "scara.urdf").write_text(SCARA)
    home = dict.fromkeys(("shoulder", "elbow", "quill", "wrist"), 0.1)
    with pytest.raises(
        UnsuitableRobot, match="with 4 joints: shoulder, .*; expected: at least six"
    ):
        load_robot(path, "link_5", home, *SIDES)
