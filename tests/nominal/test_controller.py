from itertools import product

import numpy as np
import pytest

import recalib
from replication.scenarios import nominal_controller
from tests.conftest import changed


@pytest.fixture(params=["ur10", "ur5", "ur3", "z1", "panda"])
def some(request, plan, redundant) -> recalib.Controller:
    if request.param == "panda":
        return redundant
    return nominal_controller(plan.nominal(request.param))


def test_forward_of_inverse_is_the_pose(some):
    workspace = some.robot.workspace
    poses = workspace.to_poses(workspace.sample(np.random.default_rng(1), 1000))
    reached = some.robot.arm.forward(some.inverse(poses))
    assert recalib.position_error(reached, poses).max() < 1e-9
    assert recalib.orientation_error(reached, poses).max() < 1e-9


def test_a_command_gives_the_same_angles_whatever_comes_before_and_beside_it(some):
    coordinates = 1.2 * some.robot.workspace.sample(np.random.default_rng(2), 2, 20)
    together = some.targets(coordinates).angles
    alone = some.targets(coordinates[1:, 7:8]).angles
    assert np.array_equal(alone[0, 0], together[1, 7])


def test_a_command_that_is_no_number_is_refused_alone(some):
    commands = np.zeros((1, 3, 6))
    commands[0, 0], commands[0, 1, 2] = np.nan, np.nan  # as of a learner that diverges
    np.testing.assert_array_equal(some.targets(commands).executed, [[False, False, True]])


def test_neighbouring_commands_stay_on_the_branch_of_home(some):
    path = np.linspace(-1, 1, 401)[:, None] * np.array([1, -1, 1, -1, 1, -1])
    angles = some.targets(path[None]).angles[0]
    assert np.abs(angles[200] - some.robot.home).max() < 0.01
    assert np.abs(np.diff(angles, axis=0)).max() < 0.05


def test_a_pose_out_of_reach_is_an_error_that_names_it(controller):
    pose = controller.robot.workspace.centre.copy()
    pose[0, 3] = 3.0
    with pytest.raises(recalib.Unreachable, match=r"\(3.000, .*no joint angles reach it") as caught:
        controller.inverse(np.stack([controller.robot.workspace.centre, pose]))
    assert caught.value.residual > 1 and caught.value.position[0] == 3.0


@pytest.mark.parametrize("side", [-1, 1])
def test_a_pose_beyond_a_joint_limit_on_either_side_is_an_error(plan, controller, side):
    turned = controller.robot.workspace.to_poses(np.array([[0, 0, 0, 0, 0, 5.0 * side]]))
    [[*_, angle]] = controller.inverse(turned)  # 100 degrees of yaw
    bounds = np.radians([-360, 360])
    for beyond in (True, False):
        bounds[int(angle > 0)] = angle + np.copysign(0.01, angle) * (-1 if beyond else 1)
        limited = changed(plan.nominal("ur10"), robot={"limits": {"wrist_3_joint": bounds}})
        if beyond:
            with pytest.raises(recalib.Unreachable, match="only beyond the joint limits"):
                nominal_controller(limited).inverse(turned)
        else:
            assert nominal_controller(limited).inverse(turned)[0, 5] == angle


def test_commands_beyond_the_workspace_are_solved_on_the_branch_of_home(controller):
    """As by going there in small steps, not by a polynomial of what it was never fitted to."""
    workspace, chain = controller.robot.workspace, recalib.Chain.of(controller.robot.arm)
    far = np.random.default_rng(0).uniform(-1, 1, (400, 6))
    far *= 2.5 / np.abs(far).max(axis=1, keepdims=True)
    angles, all_the_way = np.tile(controller.robot.home, (len(far), 1)), np.ones(len(far), bool)
    for part in np.linspace(0, 1, 40)[1:]:
        angles, residuals = chain.solve(workspace.to_poses(part * far), angles)
        all_the_way &= residuals < 1e-9
    found = controller.solve(workspace.to_poses(far)).angles
    alike = np.isclose(found, angles, atol=1e-6).all(axis=1)
    assert all_the_way.mean() > 0.5 and alike[all_the_way].mean() > 0.98


def test_a_command_that_turns_far_is_solved_as_its_pose(controller):
    """Since a pitch of more than a right angle is a smaller one behind two half turns."""
    workspace = controller.robot.workspace
    commands = np.zeros((1, 60, 6))
    commands[..., 3:] = np.random.default_rng(4).uniform(-3, 3, (60, 3)) / workspace.half_ranges[3:]
    found, solved = controller.targets(commands), controller.solve(workspace.to_poses(commands[0]))
    assert found.executed.any()
    assert np.allclose(found.angles[0], solved.angles, atol=1e-6)


def test_a_workspace_out_of_reach_or_too_near_to_a_singularity_is_refused(plan, robot, controller):
    nominal = plan.nominal("ur10")
    far = changed(nominal, robot={"workspace": {"position": (1.5, 1.5, 1.5)}})
    message = r"cannot reach \d+ of the 729 poses.*Make its workspace smaller"
    with pytest.raises(recalib.UnfitWorkspace, match=message):
        nominal_controller(far)
    workspace = robot.workspace
    grid = np.array([*product((-1.0, 0.0, 1.0), repeat=6)])
    _, jacobians = robot.arm.forward_and_jacobian(controller.inverse(workspace.to_poses(grid)))
    in_units = jacobians / workspace.half_ranges[:, None]
    greatest = np.linalg.svd(in_units, compute_uv=False)[:, [0, -1]]
    condition = (greatest[:, 0] / greatest[:, 1]).max()
    recalib.Controller(robot, greatest_condition=condition * 1.0001)
    with pytest.raises(recalib.UnfitWorkspace, match=f"singularity.* reaches {condition:.3g}; "):
        recalib.Controller(robot, greatest_condition=condition * 0.9999)


@pytest.mark.parametrize("limits", [(110, 350), (-350, 130)], ids=["lower", "upper"])
def test_a_workspace_beyond_a_joint_limit_is_refused(plan, limits):
    message = "move elbow_joint to .* deg in .* limits of {:.1f} deg to {:.1f} deg".format(*limits)
    limits = {"elbow_joint": np.radians(limits)}
    limited = changed(plan.nominal("ur10"), robot={"limits": limits})
    with pytest.raises(recalib.UnfitWorkspace, match=message):
        nominal_controller(limited)


def test_the_posture_changes_smoothly_and_hardly_without_moving_the_tool(redundant):
    path = np.linspace(-1, 1, 401)[:, None] * np.array([1, -1, 1, -1, 1, -1])
    angles = redundant.targets(path[None]).angles[0]
    steps = np.diff(angles, axis=0)
    assert np.abs(np.diff(steps, axis=0)).max() < 2e-3
    _, jacobians = redundant.robot.arm.forward_and_jacobian(angles[:-1])
    idle = np.array([np.linalg.svd(jacobian)[2][-1] for jacobian in jacobians])
    assert np.abs((idle * steps).sum(axis=1)).max() < 0.3 * np.linalg.norm(steps, axis=1).max()


def test_commands_are_found_for_joint_angles_that_the_controller_would_not_choose(redundant):
    """After an arm of seven joints with shifted encoders was identified from forty moves."""
    robot, rng = redundant.robot, np.random.default_rng(3)
    shifts = zip(robot.joints, np.radians([1, -2, 4, 1, -3, 2, 1]), strict=True)
    plant = recalib.Plant(
        redundant, recalib.apply(robot, [recalib.EncoderShift(*shift) for shift in shifts])
    )
    learner, practised = recalib.GeometricLearner(redundant), robot.workspace.sample(rng, 1, 40)
    learner.observe(practised, *plant.execute(practised))
    desired = robot.workspace.sample(rng, 1, 30)
    achieved, executed = plant.achieve(learner.command(desired))
    assert executed.all()
    assert recalib.position_error(achieved, robot.workspace.to_poses(desired)).max() < 1e-6
