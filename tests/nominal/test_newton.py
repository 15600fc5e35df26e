import numpy as np
import pytest

from recalib import Chain, load_arm
from recalib.nominal import LONGEST_STEP, TOLERANCE, solve_groups

# Tools, and postures away from where these arms are singular.
ARMS = {
    "ur10_robot.urdf": ("tool0", [0.0, -1.4, 2.1, -2.9, -1.6, 0.0]),
    "panda.urdf": ("panda_hand_tcp", [0.0, -0.7, 0.2, -2.1, 0.0, 1.6, 0.5]),
    "tiago.urdf": ("hand_tool_link", [0.2, 1.0, -0.5, 1.0, 1.2, -1.0, 0.5, 0.5]),
    "so100.urdf": ("gripper", [0.0, 1.0, -1.2, 0.5, 0.5]),
}


def standing(name):
    tool, posture = ARMS[name]
    return load_arm(name, tool), np.array([posture])


def by_chain(arm, poses, start):
    return Chain.of(arm).solve(poses, start)


def kinematics_of(arm, asked):
    """What `solve_groups` asks; the angles that it asks for are added to `asked`."""

    def evaluate(_, angles):
        asked.append(angles[0, 0])
        found = arm.forward_and_jacobian(angles.reshape(-1, angles.shape[-1]))
        return [values.reshape(*angles.shape[:2], *values.shape[1:]) for values in found]

    return evaluate


def in_groups(arm, goals, start, steps=15):
    found, residuals = solve_groups(
        kinematics_of(arm, []), goals[None], start[None], TOLERANCE, steps
    )
    return found[0], residuals[0]


@pytest.mark.parametrize("solve", [by_chain, in_groups])
@pytest.mark.parametrize("name", ARMS)
def test_what_an_arm_reaches_is_found_from_nearby(name, solve):
    (arm, posture), random = standing(name), np.random.default_rng(1)
    angles = posture + random.uniform(-0.3, 0.3, (20, len(arm.joints)))
    start, poses = angles + random.uniform(-0.1, 0.1, angles.shape), arm.forward(angles)
    found, residuals = solve(arm, poses, start)
    assert residuals.max() <= TOLERANCE
    np.testing.assert_allclose(arm.forward(found), poses, rtol=0, atol=1e-10)
    if len(arm.joints) <= 6:
        np.testing.assert_allclose(found, angles, rtol=0, atol=1e-8)
    else:  # hardly farther than where the pose came from
        far, farther = (np.linalg.norm(reached - start, axis=1) for reached in (found, angles))
        assert np.all(far < 1.05 * farther)


def test_no_step_is_longer_than_the_longest():
    """Else Newton's method could leave the branch that it starts on."""
    (arm, start), asked = standing("panda.urdf"), []
    goal = arm.forward(start + np.array([1.5, 0.3, 0, 0, 0, 0, 0]))
    solve_groups(kinematics_of(arm, asked), goal[None], start[None], TOLERANCE, 5)
    steps = np.abs(np.diff(asked, axis=0)).max(axis=1)
    assert steps[0] == pytest.approx(LONGEST_STEP) and steps.max() <= LONGEST_STEP + 1e-12


def test_a_step_of_a_redundant_arm_is_the_shortest():
    arm, start = standing("panda.urdf")
    pose, jacobian = arm.forward_and_jacobian(start)
    pose[0, :3, 3] += 1e-5
    angles, residuals = Chain.of(arm).solve(pose, start)
    idle = np.linalg.svd(jacobian[0])[2][-1]  # the motion that leaves the tool where it is
    assert residuals <= TOLERANCE
    assert abs(idle @ (angles - start)[0]) < 1e-4 * np.linalg.norm(angles - start)


@pytest.mark.parametrize("name", ["ur10_robot.urdf", "panda.urdf"])
def test_a_start_where_the_arm_is_singular_is_left(name):
    arm, _ = standing(name)
    straight = np.zeros((2, len(arm.joints)))
    _, jacobians = arm.forward_and_jacobian(straight)
    assert np.linalg.matrix_rank(jacobians[0]) < 6
    poses = arm.forward(straight + [0.1, 0.2, 0.1, -0.4, 0.1, 0.3, 0.1][: len(arm.joints)])
    angles, residuals = Chain.of(arm).solve(poses, straight)
    assert residuals.max() <= TOLERANCE
    assert np.allclose(arm.forward(angles), poses, atol=1e-10)


def test_where_a_group_ends_depends_on_no_other():
    arm, posture = standing("ur10_robot.urdf")
    start = np.tile(posture, (2, 1, 1))
    goals = arm.forward(start[:, 0] + [[1e-3], [0.5]])[:, None]  # the first is reached sooner
    evaluate = kinematics_of(arm, [])
    together = solve_groups(evaluate, goals, start, TOLERANCE, 15)
    for index in range(2):
        one = slice(index, index + 1)
        alone = solve_groups(evaluate, goals[one], start[one], TOLERANCE, 15)
        for found, expected in zip(alone, together, strict=True):
            assert np.array_equal(found, expected[one])


def test_of_a_pose_that_nothing_reaches_the_best_angles_are_kept(robot):
    pose = robot.arm.forward(robot.home[None])
    pose[0, 0, 3] += 3.0  # m
    angles, residuals = Chain.of(robot.arm).solve(pose, robot.home[None])
    assert TOLERANCE < residuals[0] <= 3.0
    error = pose[0, :3, 3] - robot.arm.forward(angles)[0, :3, 3]
    assert np.abs(error).max() <= residuals[0] + 1e-12


def test_positions_alone_are_reached_by_the_shortest_steps():
    arm, start = standing("ur10_robot.urdf")
    pose, jacobian = arm.forward_and_jacobian(start)
    goal = pose[:, :3, 3] + 1e-5
    angles, residuals = in_groups(arm, goal, start)
    assert residuals <= TOLERANCE
    assert np.abs(arm.forward(angles)[:, :3, 3] - goal).max() <= TOLERANCE
    shortest = np.linalg.pinv(jacobian[0, :3]) @ np.full(3, 1e-5)
    np.testing.assert_allclose((angles - start)[0], shortest, rtol=1e-3, atol=1e-9)


def test_half_a_turn_is_not_taken_for_none():
    arm, start = standing("ur10_robot.urdf")
    goal = arm.forward(start + np.pi * np.eye(6)[[5]])  # with the hand turned over
    angles, residuals = in_groups(arm, goal, start, steps=1)
    assert residuals[0] > 2
    angles, residuals = in_groups(arm, goal, start)
    assert residuals <= TOLERANCE
    np.testing.assert_allclose(arm.forward(angles), goal, rtol=0, atol=1e-10)
    _, residuals = by_chain(arm, goal, start)
    assert residuals == np.inf
