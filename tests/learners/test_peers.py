"""What every learner has to do, and how well the peers of the paper's learners do it."""

import numpy as np
import pytest

from recalib import (
    Controller,
    EccentricGear,
    EncoderShift,
    GaussianProcessLearner,
    GeometricLearner,
    LinkShortening,
    Outcome,
    Plant,
    UnknownName,
    apply,
    load_robot,
    train,
)
from recalib.learners import KINDS
from recalib.loop import measure
from replication.training import make_peer
from tests.arms import RAILED
from tests.learners.test_hierarchical import improved

RUNS = 2
DESIRED = np.random.default_rng(1).uniform(-1, 1, (RUNS, 40, 6))
TESTS = np.random.default_rng(2).uniform(-1, 1, (RUNS, 20, 6))


def trained(learner, plant, moves):
    for move in range(moves):
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
    """Also next to a run whose moves are refused; a learner of today moves once."""
    plant, own, sent = Plant(controller, damaged), Plant(controller, damaged), []
    together, alone = makers[kind](runs=2), makers[kind](runs=1)

    def refuse_the_first(commands):
        sent.append(commands.shape)
        outcome = plant.execute(commands)
        return Outcome(outcome.achieved, outcome.executed & np.array([[False], [True]]))

    for move in range(3):
        together.learn(DESIRED[:, move], refuse_the_first, move / 40)
        alone.learn(DESIRED[1:, move], own.execute, move / 40)
    assert sent == [(RUNS, 1, 6)] * 3 * (1 + (kind == "hierarchical"))
    commands = together.command(TESTS)
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
    after = errors(trained(make_peer(name, RUNS, robot), plant, moves), plant)
    assert after[0] < min(position, before[0] / 3)
    assert after[1] < min(orientation, before[1] / 3)


def test_the_hybrid_learns_what_no_geometry_explains(controller, robot):
    arm = apply(
        robot,
        [EccentricGear(joint, np.radians(0.5), phase) for phase, joint in enumerate(robot.joints)],
    )
    plant = Plant(controller, arm)
    geometric, hybrid = (
        errors(trained(make_peer(name, RUNS, robot), plant, 16), plant)
        for name in ("geometric", "hybrid")
    )
    assert geometric[1] > 0.1
    assert max(hybrid) < 0.01


DAMAGES = (
    LinkShortening("panda_link4", 0.03),
    EncoderShift("panda_joint3", np.radians(4)),
    EncoderShift("panda_joint6", np.radians(-3)),
)


def remaining(learner, plant, iterations: int, runs: int = 2) -> np.ndarray:
    """The shares of both initial errors that remain, averaged over runs."""
    random, workspace = np.random.default_rng(5), plant.workspace
    poses = workspace.sample(random, runs, iterations), workspace.sample(random, runs, 50)
    history = train(plant, learner, *poses, [0, iterations])
    errors = np.stack([history.position[..., 0], history.orientation[..., 0]])
    return (errors[..., -1] / errors[..., 0]).mean(axis=-1)


@pytest.mark.parametrize(
    ("make", "iterations", "most"),
    [
        (lambda controller: improved(runs=2), 100, 0.15),
        (lambda controller: GaussianProcessLearner(runs=2), 60, 0.02),
        (lambda controller: GeometricLearner(controller, runs=2), 12, 1e-6),
    ],
)
def test_a_learner_recalibrates_seven_joints(make, iterations, most, redundant):
    plant = Plant(redundant, apply(redundant.robot, DAMAGES))
    assert np.all(remaining(make(redundant), plant, iterations) < most)


def test_an_arm_on_a_rail_slides_and_its_slide_has_no_encoder_that_turns(tmp_path):
    (path := tmp_path / "railed.urdf").write_text(RAILED)
    home = {"pan": 0.3, "lift": -0.8, "elbow": 1.4, "bend": -0.4, "twist": 1.1, "turn": 0.5}
    sides = [0.2, 0.2, 0.2], np.radians([20, 20, 20])
    robot = load_robot(path, "link_7", {"rail": 0.2} | home, *sides)
    controller = Controller(robot)
    slid = controller.targets(robot.workspace.sample(np.random.default_rng(4), 1, 20)).angles
    assert np.ptp(slid[..., 0]) > 0.02  # m
    plant = Plant(controller, apply(robot, [EncoderShift("elbow", 0.05)]))
    assert np.all(remaining(GeometricLearner(controller, runs=2), plant, 12) < 1e-6)
    with pytest.raises(UnknownName, match="unknown turning joint 'rail'; expected: bend"):
        apply(robot, [EncoderShift("rail", 0.05)])
