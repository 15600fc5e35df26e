"""What train does with a robot, simulated or one's own, and with a learner."""

import numpy as np
import pandas as pd
import pytest

from recalib import (
    ExternalRobot,
    Outcome,
    Plant,
    PolynomialLearner,
    Workspace,
    corrected,
    position_error,
    train,
)
from recalib.loop import SUMMARIES
from tests.learners.test_hierarchical import improved


@pytest.fixture(scope="module")
def poses():
    rng = np.random.default_rng(11)
    return rng.uniform(-1, 1, (3, 60, 6)), rng.uniform(-1, 1, (3, 50, 6))


@pytest.fixture(scope="module")
def history(controller, damaged, poses):
    return train(Plant(controller, damaged), improved(3), *poses, range(0, 61, 4))


def test_a_summary_is_the_mean_the_95th_percentile_and_the_largest():
    errors = np.stack([np.arange(101.0) ** 2, np.ones(101)])
    summaries = [summary(errors) for summary in SUMMARIES.values()]
    assert np.array_equal(summaries, [[3350, 1], [95**2, 1], [100**2, 1]])
    assert list(SUMMARIES) == ["", "_p95", "_max"]


class Watched:
    """A robot that stays where it is, and a learner that records what it is given."""

    moves, refused = 0, 0

    def __init__(self, workspace):
        self.workspace, self.learned, self.asked = workspace, [], []

    def achieve(self, commands):
        executed = np.ones(commands.shape[:-1], dtype=bool)
        return self.workspace.to_poses(np.zeros_like(commands)), executed

    def execute(self, commands):
        self.moves += commands.shape[1]
        return Outcome(np.zeros_like(commands), np.ones(commands.shape[:-1], dtype=bool))

    def command(self, desired):
        self.asked.append(len(self.learned))
        return desired

    def learn(self, desired, execute, fraction):
        execute(desired[:, None])
        self.learned.append((desired[0, 0], fraction))


def test_a_learner_is_told_each_pose_in_turn_and_what_fraction_of_the_training_is_done(robot):
    both = Watched(robot.workspace)
    desired, tests = np.zeros((1, 4, 6)), np.zeros((1, 3, 6))
    desired[0, :, 0] = 0.1, 0.2, 0.3, 0.4
    tests[0, :, 0] = 1.0, -1.0, 0.5
    reported = []
    history = train(both, both, desired, tests, [0, 3, 4], lambda *row: reported.append(row))
    assert both.learned == [(0.1, 0.0), (0.2, 0.25), (0.3, 0.5), (0.4, 0.75)]
    assert both.asked == [0, 3, 4] == history.iterations.tolist() == history.moves.tolist()
    # a quarter of a metre to either side, and half of that
    assert history.position[0] == pytest.approx(np.tile([0.25 * 2.5 / 3, 0.25, 0.25], (3, 1)))
    assert np.abs(history.orientation).max() < 1e-7
    assert reported[1] == (3, pytest.approx(25 * 2.5 / 3), pytest.approx(0, abs=1e-5))


def test_one_robot_has_no_run_axis(history, controller, damaged, poses):
    plant, alone = Plant(controller, damaged), improved(1)
    of_one = train(plant, alone, poses[0][2], poses[1][2], history.iterations)
    among = history.of_run(2)
    assert np.allclose(of_one.position, among.position, rtol=1e-9)
    assert of_one.refused.shape == of_one.position_error.shape == (len(history.iterations),)
    assert np.array_equal(of_one.position_error, of_one.position[:, 0])
    assert np.array_equal(of_one.orientation_error, of_one.orientation[:, 0])
    assert len(pd.DataFrame(of_one.columns())) == len(history.iterations)
    workspace = controller.robot.workspace
    desired = workspace.to_poses(poses[1][2])
    reached = damaged.forward(controller.inverse(corrected(alone, workspace, desired)))
    assert position_error(reached, desired).mean() == pytest.approx(of_one.position_error[-1])


def test_refused_moves_are_counted_and_the_run_goes_on(controller, damaged, poses):
    desired = poses[0].copy()
    desired[1, 5, :3] = 20  # five metres away
    plant = Plant(controller, damaged)
    history = train(plant, improved(3), desired, poses[1], [0, 5, 6, 60])
    assert history.refused[1].tolist() == [0, 0, 2, 2] and not history.refused[[0, 2]].any()
    assert history.position[1, -1, 0] < 0.3 * history.position[1, 0, 0]


def test_the_table_has_a_row_for_each_run_and_measurement(history):
    frame = pd.DataFrame(history.columns())
    assert len(frame) == 3 * len(history.iterations)
    last = frame[(frame["run"] == 2) & (frame["iteration"] == 60)].iloc[0]
    assert last["position_error_cm"] == 100 * history.position[2, -1, 0]
    assert last["orientation_error_max_deg"] == np.degrees(history.orientation[2, -1, 2])


def test_each_measurement_that_is_asked_for_is_made_once(controller, damaged, poses):
    desired, tests = poses[0][:, :4], poses[1]
    history = train(Plant(controller, damaged), improved(3), desired, tests, iter([4, 0, 4]))
    assert history.iterations.tolist() == [0, 4]
    assert history.position.shape == (3, 2, len(SUMMARIES))


CENTRE = np.diag([1.0, -1.0, -1.0, 1.0])
WORKSPACE = Workspace(CENTRE, np.array([0.2, 0.2, 0.2, 0.3, 0.3, 0.3]))
PUSHED = np.eye(4)
PUSHED[:3, 3] = 0.01, 0.0, -0.02  # m


@pytest.fixture
def external() -> ExternalRobot:
    """Pushed; it refuses whatever is commanded beyond half of the workspace's width."""
    return ExternalRobot(WORKSPACE, lambda pose: PUSHED @ pose if pose[0, 3] < 0.1 else None)


def test_an_own_robot_measures_coordinates_and_stays_at_home_if_it_refuses(external):
    commands = np.random.default_rng(1).uniform(-1, 0, (2, 3, 6))
    achieved, executed = external.execute(commands)
    assert np.allclose(achieved - commands, [0.05, 0, -0.1, 0, 0, 0])
    assert executed.all()
    commands = np.zeros((2, 3, 6))
    commands[1, :2, 0] = 0.9
    achieved, executed = external.execute(commands)
    assert executed.tolist() == [[True] * 3, [False, False, True]]
    assert not achieved[1, :2].any()
    assert external.moves == 6 and external.refused.tolist() == [0, 2]


def test_it_takes_the_place_of_a_plant(external):
    rng = np.random.default_rng(2)
    desired, tests = WORKSPACE.sample(rng, 2, 30), 0.4 * WORKSPACE.sample(rng, 2, 20)
    history = train(external, PolynomialLearner(degree=1, runs=2), desired, tests, [0, 30])
    assert history.position[:, 0, 0] == pytest.approx(np.hypot(0.01, 0.02))
    assert history.position[:, 1, 2].max() < 1e-4
    assert history.moves.tolist() == [0, 30] and (history.refused[:, 1] > 0).all()
