"""Recursive least squares end where least squares of everything at once do, with the prior."""

from itertools import combinations_with_replacement

import numpy as np
import pytest

from recalib import PolynomialLearner

# Deviations of the coefficients of each degree, and of what no polynomial says; in half-ranges
PRIOR, NOISE = (0.3, 0.1, 0.03), 0.003


def features(points, degree):
    """Every product of up to so many coordinates, and its degree."""
    products = [
        chosen
        for each in range(degree + 1)
        for chosen in combinations_with_replacement(range(6), each)
    ]
    columns = [np.prod(points[:, list(chosen)], axis=1) for chosen in products]
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
    asked = rng.uniform(-1, 1, (2, 4, 6))
    commands = learner.command(asked)
    for run in range(2):
        there, degrees = features(achieved[run, executed[run]], degree)
        missed = (sent - achieved)[run, executed[run]]
        weights = np.diag((NOISE / np.array(PRIOR)[degrees]) ** 2)
        solved = np.linalg.solve(there.T @ there + weights, there.T @ missed)
        expected = asked[run] + features(asked[run], degree)[0] @ solved
        np.testing.assert_allclose(commands[run], expected, rtol=0, atol=1e-9)
