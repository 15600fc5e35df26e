import numpy as np
import pytest

from recalib import ExternalRobot, PolynomialLearner, Workspace, train

CENTRE = np.diag([1.0, -1.0, -1.0, 1.0])
WORKSPACE = Workspace(CENTRE, np.array([0.2, 0.2, 0.2, 0.3, 0.3, 0.3]))
PUSHED = np.eye(4)
PUSHED[:3, 3] = 0.01, 0.0, -0.02  # m


@pytest.fixture
def robot() -> ExternalRobot:
    """Pushed; it refuses whatever is commanded beyond half of the workspace's width."""
    return ExternalRobot(WORKSPACE, lambda pose: PUSHED @ pose if pose[0, 3] < 0.1 else None)


def test_commands_and_measured_poses_are_coordinates_of_the_workspace(robot):
    commands = np.random.default_rng(1).uniform(-1, 0, (2, 3, 6))
    achieved, executed = robot.execute(commands)
    assert np.allclose(achieved - commands, [0.05, 0, -0.1, 0, 0, 0])
    assert executed.all()


def test_refused_moves_are_counted_and_leave_the_robot_at_home(robot):
    commands = np.zeros((2, 3, 6))
    commands[1, :2, 0] = 0.9
    achieved, executed = robot.execute(commands)
    assert executed.tolist() == [[True] * 3, [False, False, True]]
    assert not achieved[1, :2].any()
    assert robot.moves == 3 and robot.refused.tolist() == [0, 2]


def test_it_takes_the_place_of_a_plant(robot):
    rng = np.random.default_rng(2)
    desired, tests = WORKSPACE.sample(rng, 2, 30), 0.4 * WORKSPACE.sample(rng, 2, 20)
    history = train(robot, PolynomialLearner(degree=1, runs=2), desired, tests, [0, 30])
    assert history.position[:, 0, 0] == pytest.approx(np.hypot(0.01, 0.02))
    assert history.position[:, 1, 2].max() < 1e-4
    assert history.moves.tolist() == [0, 30] and (history.refused[:, 1] > 0).all()
