"""What every learner has to do, and how well the peers of the paper's learners do it."""

import numpy as np
import pytest

from recalib import EccentricGear, InvalidSetting, Outcome, Plant, PolynomialLearner, apply
from recalib.learners import KINDS
from recalib.loop import measure
from replication.training import make_peer

RUNS = 2


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


EVERY = pytest.mark.parametrize("kind", [*KINDS, "radial"])


@EVERY
def test_a_learner_that_has_learned_nothing_commands_what_is_desired(kind, makers):
    assert makers[kind](runs=RUNS).command(3 * TESTS) == pytest.approx(3 * TESTS, abs=1e-14)


@EVERY
def test_a_run_learns_as_if_it_were_alone_and_nothing_of_refused_moves(
    kind, makers, controller, damaged
):
    """Also beside a run whose moves are refused; a learner of today moves once."""
    plant, sent = Plant(controller, damaged), []
    beside, alone = makers[kind](runs=2), makers[kind](runs=1)

    def refuse_the_first(commands):
        sent.append(commands.shape)
        outcome = plant.execute(commands)
        return Outcome(outcome.achieved, outcome.executed & np.array([[False], [True]]))

    for move in range(3):
        beside.learn(DESIRED[:, move], refuse_the_first, move / 40)
        alone.learn(DESIRED[1:, move], plant.execute, move / 40)
    assert sent == [(RUNS, 1, 6)] * 3 * (1 + (kind == "hierarchical"))
    commands = beside.command(TESTS)
    assert commands[0] == pytest.approx(TESTS[0], abs=1e-14)
    assert np.abs(commands[1] - TESTS[1]).max() > 1e-2
    assert np.array_equal(commands[1:], alone.command(TESTS[1:]))


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
