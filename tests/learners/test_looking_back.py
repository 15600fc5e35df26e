"""Learners that look back: when they learn anew, from what, and what they keep."""

from itertools import combinations_with_replacement, pairwise

import numpy as np
import pytest

from recalib import GaussianProcessLearner, GeometricLearner, HybridLearner, PolynomialLearner
from recalib.learners import is_due
from recalib.numerics import Process

MOVES = 10
SENT = np.random.default_rng(3).uniform(-1, 1, (2, MOVES, 6))
ACHIEVED = SENT + 0.1 * np.sin(SENT[..., ::-1])
EXECUTED = np.ones((2, MOVES), dtype=bool)
EXECUTED[0, 4] = False


def observed(learner, first, last):
    moves = slice(first, last)
    learner.observe(SENT[:, moves], ACHIEVED[:, moves], EXECUTED[:, moves])
    return learner


def test_looking_back_gets_rarer_and_never_lacks_more_than_a_fifth():
    due = [moves for moves in range(1, 1000) if is_due(moves - 1, moves)]
    assert due[:16] == [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32]
    assert all(after <= 1.25 * before for before, after in pairwise(due[3:]))
    assert is_due(0, 1000) and not is_due(1000, 1001)


def test_the_process_is_that_of_the_moves_that_were_carried_out():
    learner = observed(GaussianProcessLearner(runs=2), 0, MOVES)
    desired = np.random.default_rng(4).uniform(-1, 1, (2, 3, 6))
    commands = learner.command(desired)
    for run in range(2):
        executed = EXECUTED[run]
        process = Process(ACHIEVED[run, executed], (SENT - ACHIEVED)[run, executed])
        np.testing.assert_allclose(commands[run], desired[run] + process.predict(desired[run]))


def test_hyperparameters_are_sought_anew_when_the_moves_have_doubled_and_kept_between():
    learner, hyperparameters = GaussianProcessLearner(runs=2), []
    for move in range(MOVES):
        state = observed(learner, move, move + 1).state()[1]
        assert state["moves"]["executed"].shape == (move + 1,)
        hyperparameters.append(tuple(state["process"]["hyperparameters"]))
    # fewer than six moves say nothing of them; from eight on they are sought, and at sixteen anew
    assert len({*hyperparameters[:7]}) == 1 != len({*hyperparameters[6:8]})
    assert len({*hyperparameters[7:]}) == 1
    lengths = [len(observed(learner, 0, 0).state()[run]["process"]["inputs"]) for run in (0, 1)]
    assert lengths == [MOVES - 1, MOVES]


@pytest.mark.parametrize("kind", [GeometricLearner, HybridLearner])
def test_an_identified_arm_is_asked_for_angles_and_its_nominal_twin_for_the_command(
    kind, controller, damaged
):
    workspace, learner = controller.robot.workspace, kind(controller, runs=2)
    targets = controller.targets(SENT)
    poses = damaged.forward(targets.angles.reshape(-1, 6)).reshape(2, MOVES, 4, 4)
    executed = EXECUTED & targets.executed
    learner.observe(SENT, workspace.to_coordinates(poses), executed)
    commands = learner.command(SENT)
    for run, calibration in enumerate(learner.models):
        assert len(calibration.estimate.weights) == executed[run].sum()
        angles = controller.targets(commands[run][None]).angles[0]
        found = workspace.to_coordinates(calibration.forward(angles))
        np.testing.assert_allclose(found, SENT[run], rtol=0, atol=1e-6)
    fresh = kind(controller, runs=2)
    fresh.restore(learner.state())
    assert np.array_equal(fresh.command(SENT), commands)


# Deviations of the coefficients of each degree, and of what no polynomial says; in half-ranges
PRIOR, NOISE = (0.3, 0.1, 0.03), 0.003


def features(points, degree):
    """Every product of up to so many coordinates, and its degree."""
    products = [
        indices
        for count in range(degree + 1)
        for indices in combinations_with_replacement(range(6), count)
    ]
    columns = [np.prod(points[:, list(indices)], axis=1) for indices in products]
    return np.stack(columns, axis=1), np.array([*map(len, products)])


@pytest.mark.parametrize("degree", [1, 2])
def test_what_is_learned_is_the_regularised_least_squares_solution(degree):
    rng = np.random.default_rng(1)
    sent = rng.uniform(-1, 1, (2, 25, 6))
    achieved = sent + 0.1 * np.sin(2 * sent[..., ::-1]) + 0.05
    executed = np.ones((2, 25), dtype=bool)
    executed[0, [3, 20]] = False
    learner = PolynomialLearner(degree, runs=2)
    for first, last in ((0, 1), (1, 8), (8, 25)):  # one at a time or several: no difference
        moves = slice(first, last)
        learner.observe(sent[:, moves], achieved[:, moves], executed[:, moves])
    desired = rng.uniform(-1, 1, (2, 4, 6))
    commands = learner.command(desired)
    for run in range(2):
        columns, degrees = features(achieved[run, executed[run]], degree)
        errors = (sent - achieved)[run, executed[run]]
        weights = np.diag((NOISE / np.array(PRIOR)[degrees]) ** 2)
        coefficients = np.linalg.solve(columns.T @ columns + weights, columns.T @ errors)
        expected = desired[run] + features(desired[run], degree)[0] @ coefficients
        np.testing.assert_allclose(commands[run], expected, rtol=0, atol=1e-9)
