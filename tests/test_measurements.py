"""Bad measurements are refused by their name, or survived: never a quiet wrong answer."""

from dataclasses import replace

import numpy as np
import pytest

from recalib import OFFSETS, BadMeasurement, ExternalRobot, Observations, Outcome, position_error
from recalib.identification import calibrate, identify
from recalib.identification.model import ErrorModel
from recalib.learners import KINDS
from recalib.loop import check_moves

RUNS = 2
DESIRED = np.random.default_rng(1).uniform(-1, 1, (RUNS, 6))
TESTS = np.random.default_rng(2).uniform(-1, 1, (RUNS, 5, 6))


@pytest.mark.parametrize("executed", [True, False], ids=["executed", "refused"])
@pytest.mark.parametrize("bad", [np.nan, -np.inf, 1e7])
@pytest.mark.parametrize("name", [*KINDS, "radial"])
def test_a_learner_refuses_what_is_no_number_and_keeps_what_it_knew(name, bad, executed, makers):
    learner = makers[name](runs=RUNS)
    before = learner.command(TESTS)

    def execute(commands):
        achieved = commands + 0.1
        achieved[1, 0, 4] = bad
        return Outcome(achieved, np.full(commands.shape[:2], executed))

    with pytest.raises(BadMeasurement, match=r"move 0 of run 1 measured \(.*; expected: six coord"):
        learner.learn(DESIRED, execute, 0.0)
    assert np.array_equal(learner.command(TESTS), before)


@pytest.mark.parametrize("name", [name for name in KINDS if name != "hierarchical"])
def test_a_refused_command_that_is_no_number_spoils_nothing(name, makers):
    first, second = makers[name](runs=RUNS), makers[name](runs=RUNS)
    sent, executed = np.stack([DESIRED, -DESIRED], axis=1), np.array([[True, False]] * RUNS)
    for learner, refused in ((first, np.nan), (second, 0.5)):
        commands = np.where(executed[..., None], sent, refused)
        learner.observe(commands, np.where(executed[..., None], 0.9 * sent, 0.0), executed)
    assert np.array_equal(first.command(TESTS), second.command(TESTS))


UNIT = np.eye(6)[3]  # of the coordinates that a learner sees, along one of them
SPOILT = {
    "an outlier of 30 units": lambda achieved, step: achieved + 30 * UNIT * (step == 5),
    "an outlier of 8 units": lambda achieved, step: achieved - 8 * UNIT * (step == 5),
    "another unit, 100 of which are one": lambda achieved, step: 100 * achieved,
    "angles in degrees": lambda achieved, step: achieved * [1, 1, 1, 57.3, 57.3, 57.3],
    "every pose the same": lambda achieved, step: np.full_like(achieved, 0.3),
    "every pose the same, with noise": lambda achieved, step: 0.3 + 1e-3 * achieved,
}


@pytest.mark.parametrize("spoil", SPOILT.values(), ids=SPOILT)
@pytest.mark.parametrize("name", KINDS)
def test_no_learner_takes_what_no_damage_explains(name, spoil, makers):
    learner, poses = makers[name](runs=RUNS), np.random.default_rng(4).uniform(-1, 1, (8, RUNS, 6))

    def learn():
        for step, desired in enumerate(poses):
            learner.learn(
                desired,
                lambda commands, step=step: Outcome(
                    spoil(commands + 0.1, step), np.ones(commands.shape[:2], dtype=bool)
                ),
                step / len(poses),
            )

    message = r"move 0 of run 0 .*; expected: (six|a pose that differs)"
    with pytest.raises(BadMeasurement, match=message):
        learn()


def test_what_the_study_does_is_taken():
    """Turns beyond half a turn and back, serious damage, learners that diverge, refused moves."""
    sent = np.array([[[0, 0, 0, 20.0, 0, 0], [0.9] * 6, [np.nan] * 6, [1e9] * 6]])
    came = np.array([[[0, 0, 0, 2.0, 9, 9], [3.0] * 6, [0.1] * 6, [0.1] * 6]])
    executed = np.array([[True, True, False, False]])
    last = check_moves(sent, came, executed)
    assert [part.shape for part in last] == [(1, 1, 6), (1, 1, 6), (1, 1)]
    check_moves(sent[:, 1:2], came[:, 3:], np.array([[True]]), last)  # no move precedes it


@pytest.mark.parametrize("name", KINDS)
def test_a_learner_survives_equal_poses(name, makers):
    learner = makers[name](runs=RUNS)
    for step in range(20):
        learner.learn(
            DESIRED,
            lambda commands: Outcome(commands + 0.01, np.ones(commands.shape[:2], dtype=bool)),
            step / 20,
        )
    residuals = learner.command(DESIRED[:, None]) + 0.01 - DESIRED[:, None]
    assert np.abs(residuals).max() < 0.005
    assert np.isfinite(learner.command(TESTS)).all()


def scaled(pose, factor):
    far = pose.copy()
    far[:3, 3] *= factor
    return far


@pytest.mark.parametrize(
    ("spoil", "valid"),
    [
        (lambda pose: np.where(np.eye(4) > 0, np.nan, pose), "numbers"),
        (lambda pose: scaled(pose, np.inf), "numbers"),
        (lambda pose: scaled(pose, 1000), "m in the base frame, at most 10 m"),
        (lambda pose: pose[:3], r"a matrix \(4, 4\)"),
        (lambda pose: pose[:3, 3], r"a matrix \(4, 4\)"),
        (lambda pose: pose * [[-1, 1, 1, 1]] * 1.0, "a rotation"),
        (lambda pose: 2 * pose, "a rotation"),
        (lambda pose: pose.T, "a rotation"),
    ],
    ids=["NaN", "infinity", "mm", "no last row", "position", "mirrored", "twice", "transposed"],
)
def test_an_external_robot_that_measures_no_pose_is_told_so(spoil, valid, robot):
    external = ExternalRobot(robot.workspace, spoil)
    with pytest.raises(BadMeasurement, match=rf"^the robot measured \(.*; expected: {valid}"):
        external.execute(DESIRED[:, None])


@pytest.fixture(scope="module")
def table(robot, damaged):
    """Joint angles [rad] and poses measured at 0.1 mm."""
    random = np.random.default_rng(3)
    angles = robot.home + random.uniform(-0.5, 0.5, (20, 6))
    measured = damaged.forward(angles)
    measured[:, :3, 3] += random.normal(scale=1e-4, size=(20, 3))
    return angles, measured


def test_an_identification_that_is_led_astray_names_a_measurement(table, robot):
    """To where a link has turned once around, and no small change of its turn means anything."""
    model, observations = ErrorModel(robot.arm, OFFSETS), Observations(*table)
    astray = np.zeros_like(model.deviations)
    astray[9] = 2 * np.pi
    start = replace(identify(model, observations), parameters=astray)
    with pytest.raises(BadMeasurement, match="measurement 0 .*: a measurement of the same arm"):
        identify(model, observations, start)


@pytest.mark.parametrize("rows", [[0], [0] * 20], ids=["one", "twenty times the same"])
def test_little_is_learned_from_little_and_nothing_is_spoilt(rows, table, robot, damaged):
    angles, measured = table
    found = calibrate(robot.arm, [OFFSETS], Observations(angles[rows], measured[rows]))
    before, after = (
        position_error(arm.forward(angles), damaged.forward(angles)) for arm in (robot.arm, found)
    )
    assert after[0] < 0.1 * before[0]
    assert after.mean() < 1.5 * before.mean()
