"""Inverse kinematics by Newton's method: joint angles that take a tool to poses."""

from collections.abc import Callable

import numpy as np

from recalib.nominal.chain import Chain

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch that it starts on
SINGULAR = 1e9  # rad: a step so long comes from a singular Jacobian

BLOCK = 500  # poses that are solved together: the processor's cache holds them

# Of x, y and z the two others, in a circle: a cross product is a[NEXT] b[LAST] - a[LAST] b[NEXT].
NEXT, LAST = [1, 2, 0], [2, 0, 1]

# From the groups (m,) that are asked for and their joint angles (m, n, 6) [rad] to the poses
# (m, n, 3 or 4, 4) [m] of the tool, the tool's Jacobians (m, n, 6, 6) there, and the point
# (m, n, 3) [m] on the tool's link whose linear velocity they give.
Look = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def solve_newton(
    chain: Chain, poses: np.ndarray, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (n, 6) [rad] that take the arm's tool to poses, each solved by itself.

    Args:
        chain: the arm's.
        poses: (n, 4, 4) of the tool in the base frame [m].
        start: (n, 6) rad nearby.

    Returns the angles and what is left of each residual (n,), in m and rad: above TOLERANCE, the
    pose was not reached.
    """
    angles, residuals = np.empty(start.shape), np.empty(len(start))
    for first in range(0, len(start), BLOCK):
        block = slice(first, first + BLOCK), None
        angles[block], residuals[block] = solve_groups(
            lambda _, angles: chain.move(angles), poses[block], start[block], TOLERANCE, STEPS
        )
    return angles, residuals


def solve_groups(
    look: Look, poses: np.ndarray, start: np.ndarray, tolerance: float, steps: int
) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (group, n, 6) [rad] that take tools to poses, and what is left (group, n).

    A group is solved when all of its poses are; where one is not, its best angles are kept.

    Args:
        poses: (group, n, 4, 4) m.
        start: (group, n, 6) rad nearby.
        tolerance: of the residuals, in m and rad.
        steps: at most so many.
    """
    found, left = start.copy(), np.full(start.shape[:2], np.inf)
    unsolved, goals, angles, best, least = np.arange(len(poses)), poses, start, found, left
    for _ in range(steps):
        reached, jacobians, points = look(unsolved, angles)
        missing = _missing(reached, goals)
        residuals = np.abs(missing).max(axis=-1)
        better = residuals < least
        if better.all():
            best, least = angles, residuals
        else:
            best = np.where(better[..., None], angles, best)
            least = np.where(better, residuals, least)
        goes_on = (least > tolerance).any(axis=1)
        if not goes_on.any():
            break
        levers = points - reached[..., :3, 3]
        if not goes_on.all():
            found[unsolved], left[unsolved] = best, least
            unsolved, goals, angles, best, least, jacobians, missing, levers = (
                each[goes_on]
                for each in (unsolved, goals, angles, best, least, jacobians, missing, levers)
            )
        missing[..., :3] += _cross(missing[..., 3:], levers)
        turns = _solve_each(jacobians, missing)
        longest = np.abs(turns).max(axis=-1, keepdims=True)
        if longest.max() > LONGEST_STEP:
            turns *= LONGEST_STEP / np.maximum(LONGEST_STEP, longest)
        angles = angles + turns
    found[unsolved], left[unsolved] = best, least
    return found, left


def _missing(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes the poses `start` (..., 3 or 4, 4) to `end`, (..., 6), along the base's axes.

    The translation [m], and the turn as its axis times the sine of its angle [rad], which is the
    angle itself where Newton's method ends.
    """
    between = end[..., :3, :3] @ start[..., :3, :3].swapaxes(-2, -1)
    missing = np.empty((*between.shape[:-2], 6))
    missing[..., :3] = end[..., :3, 3] - start[..., :3, 3]
    missing[..., 3:] = (between - between.swapaxes(-2, -1))[..., LAST, NEXT] / 2
    return missing


def _cross(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The cross products (..., 3) of vectors, faster than NumPy's where they are few."""
    return one[..., NEXT] * other[..., LAST] - one[..., LAST] * other[..., NEXT]


def _solve_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The solutions (..., 6) of linear equations; of a singular one the smallest."""
    try:
        solutions = np.linalg.solve(matrices, vectors[..., None])[..., 0]
    except np.linalg.LinAlgError:  # one of them is exactly singular
        solutions = np.full(vectors.shape, np.inf)
    longest = np.abs(solutions).max(axis=-1)
    if (singular := longest > SINGULAR).any():
        inverses = np.linalg.pinv(matrices[singular], rcond=1 / SINGULAR)
        solutions[singular] = (inverses @ vectors[singular][..., None])[..., 0]
    return solutions
