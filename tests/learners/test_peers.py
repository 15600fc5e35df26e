"""What every peer of the paper's learners has to do, and how well each does it."""

import numpy as np
import pytest

from recalib import EccentricGear, InvalidSetting, Outcome, Plant, PolynomialLearner, apply
from recalib.loop import measure
from replication.training import UNCORRECTED, make_peer, peers

RUNS = 2


NAMES = [*peers()]
LEARNING = [name for name in NAMES if name != UNCORRECTED]
DESIRED = np.random.default_rng(1).uniform(-1, 1, (RUNS, 40, 6))
TESTS = np.random.default_rng(2).uniform(-1, 1, (RUNS, 20, 6))


def train(learner, plant, moves, first=0):
    for move in range(first, moves):
        learner.learn(DESIRED[:, move], plant.execute, move / moves)
    return learner


def errors(learner, plant) -> tuple[float, float]:
    """Mean errors in cm and degrees."""
    position, orientation = measure(plant, learner, TESTS)
    return 100 * position[:, 0].mean(), np.degrees(orientation[:, 0].mean())


@pytest.mark.parametrize("name", NAMES)
def test_a_learner_that_has_learned_nothing_commands_what_is_desired(name, robot):
    assert np.array_equal(make_peer(name, RUNS, robot).command(TESTS), TESTS)


@pytest.mark.parametrize("name", NAMES)
def test_learning_takes_one_move_and_a_refused_move_teaches_nothing(name, robot):
    learner, sent = make_peer(name, RUNS, robot), []

    def refuse(commands):
        sent.append(commands.shape)
        return Outcome(np.zeros_like(commands), np.zeros(commands.shape[:2], dtype=bool))

    learner.learn(DESIRED[:, 0], refuse, 0.0)
    assert sent == [(RUNS, 1, 6)]
    assert np.array_equal(learner.command(TESTS), TESTS)


@pytest.mark.parametrize("name", LEARNING)
def test_one_run_can_be_refused_while_the_other_learns(name, robot, controller, damaged):
    plant, learner = Plant(controller, damaged), make_peer(name, RUNS, robot)

    def refuse_the_first(commands):
        outcome = plant.execute(commands)
        return Outcome(outcome.achieved, outcome.executed & np.array([[False], [True]]))

    learner.learn(DESIRED[:, 0], refuse_the_first, 0.0)
    commands = learner.command(TESTS)
    assert np.array_equal(commands[0], TESTS[0])
    assert np.abs(commands[1] - TESTS[1]).max() > 1e-2


@pytest.mark.parametrize(
    ("name", "moves", "position", "orientation"),
    [
        ("affine", 24, 1.0, 1.0),
        ("quadratic", 40, 0.8, 0.6),
        ("gaussian_process", 40, 0.4, 0.4),
        ("geometric", 7, 1e-4, 1e-4),
        ("hybrid", 7, 1e-4, 1e-4),
    ],
)
def test_errors_fall(name, moves, position, orientation, robot, controller, damaged):
    plant = Plant(controller, damaged)
    before = errors(make_peer(name, RUNS, robot), plant)
    after = errors(train(make_peer(name, RUNS, robot), plant, moves), plant)
    assert after[0] < min(position, before[0] / 3)
    assert after[1] < min(orientation, before[1] / 3)


def test_the_hybrid_learns_what_no_geometry_explains(controller, robot):
    arm = apply(
        robot,
        [EccentricGear(joint, np.radians(0.5), phase) for phase, joint in enumerate(robot.joints)],
    )
    plant = Plant(controller, arm)
    geometric, hybrid = (
        errors(train(make_peer(name, RUNS, robot), plant, 16), plant)
        for name in ("geometric", "hybrid")
    )
    assert geometric[1] > 0.1
    assert max(hybrid) < 0.01


def test_a_polynomial_of_another_degree_is_refused():
    with pytest.raises(InvalidSetting, match="1 or 2"):
        PolynomialLearner(3, runs=RUNS)
