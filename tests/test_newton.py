import numpy as np

from recalib.nominal.chain import TOLERANCE, Chain


def test_a_start_where_the_arm_is_singular_is_left(robot):
    straight = np.zeros((2, 6))
    _, jacobians = robot.arm.forward_and_jacobian(straight)
    assert np.linalg.matrix_rank(jacobians[0]) < 6
    near = robot.arm.forward(np.full((2, 6), 0.3))
    angles, residuals = Chain.of(robot.arm).solve(near, straight)
    assert residuals.max() <= TOLERANCE
    assert np.allclose(robot.arm.forward(angles), near, atol=1e-10)


def test_of_a_pose_that_nothing_reaches_the_best_angles_are_kept(robot):
    pose = robot.arm.forward(robot.home[None])
    pose[0, 0, 3] += 3.0  # m
    angles, residuals = Chain.of(robot.arm).solve(pose, robot.home[None])
    assert TOLERANCE < residuals[0] <= 3.0
    missed = pose[0, :3, 3] - robot.arm.forward(angles)[0, :3, 3]
    assert np.abs(missed).max() <= residuals[0] + 1e-12
