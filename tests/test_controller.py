import numpy as np
import pytest

from recalib.errors import UnfitWorkspace, Unreachable
from recalib.nominal.controller import Controller
from recalib.nominal.poses import orientation_error, position_error
from recalib.study.plants import nominal_controller
from tests.conftest import changed


@pytest.mark.parametrize("name", ["ur10", "ur5", "ur3", "z1"])
def test_forward_of_inverse_is_the_pose(name, plan):
    controller = nominal_controller(plan.nominal(name))
    workspace = controller.robot.workspace
    poses = workspace.to_poses(
        workspace.sample(np.random.default_rng(1), 10_000 if name == "ur10" else 1000)
    )
    reached = controller.robot.arm.forward(controller.inverse(poses))
    assert position_error(reached, poses).max() < 1e-9
    assert orientation_error(reached, poses).max() < 1e-9


def test_a_command_gives_the_same_angles_whatever_comes_before_and_beside_it(controller):
    workspace = controller.robot.workspace
    poses = workspace.to_poses(workspace.sample(np.random.default_rng(2), 40) * 1.2)
    together = controller.solve(poses).angles
    alone = np.concatenate([controller.solve(pose[None]).angles for pose in poses[::-1]])[::-1]
    assert np.array_equal(together, alone)


def test_neighbouring_commands_stay_on_the_branch_of_home(controller):
    workspace = controller.robot.workspace
    path = np.linspace(-1, 1, 400)[:, None] * np.array([1, -1, 1, -1, 1, -1])
    angles = controller.inverse(workspace.to_poses(path))
    assert np.abs(np.diff(angles, axis=0)).max() < 0.05


def test_a_pose_out_of_reach_is_an_error_that_names_it(controller):
    pose = controller.robot.workspace.centre.copy()
    pose[0, 3] = 3.0
    with pytest.raises(
        Unreachable, match=r"\(3.000, .*no joint angles reach it \(residual"
    ) as caught:
        controller.inverse(np.stack([controller.robot.workspace.centre, pose]))
    assert caught.value.residual > 1 and caught.value.position[0] == 3.0


def test_a_pose_beyond_the_joint_limits_is_an_error(plan):
    limits = {"wrist_3_joint": np.radians([-80, 80])}
    controller = nominal_controller(changed(plan.nominal("ur10"), limits=limits))
    turned = np.array([[0, 0, 0, 0, 0, 5.0]])  # 100 degrees of yaw
    with pytest.raises(Unreachable, match="only beyond the joint limits"):
        controller.inverse(controller.robot.workspace.to_poses(turned))


def test_a_workspace_out_of_reach_is_refused(plan):
    nominal = plan.nominal("ur10")
    far = nominal.robot.workspace.model_copy(update={"position": (1.5, 1.5, 1.5)})
    message = r"cannot reach \d+ of the 729 poses.*Make its workspace smaller"
    with pytest.raises(UnfitWorkspace, match=message):
        nominal_controller(changed(nominal, workspace=far))


def test_a_workspace_beyond_the_joint_limits_is_refused(plan):
    limits = {"elbow_joint": np.radians([110, 130])}
    message = "turn elbow_joint to .* beyond its limits of 110.0 to 130.0 deg"
    with pytest.raises(UnfitWorkspace, match=message):
        nominal_controller(changed(plan.nominal("ur10"), limits=limits))


def test_a_workspace_near_a_singularity_is_refused(robot):
    with pytest.raises(UnfitWorkspace, match="singularity"):
        Controller(robot, greatest_condition=5)
