"""Inverse kinematics by Newton's method: joint angles that take a tool to poses."""

from collections.abc import Callable

import numpy as np

from recalib.nominal.kinematics import Arm

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch that it starts on

# From the groups (m,) that are asked for and their joint angles (m, n, 6) [rad] to the poses
# (m, n, 4, 4) [m] of the tool and its Jacobians (m, n, 6, 6) there.
Look = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def solve_newton(arm: Arm, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (n, 6) [rad] that take the arm's tool to poses, each solved by itself.

    Args:
        poses: (n, 4, 4) of the tool in the base frame [m].
        start: (n, 6) rad nearby.

    Returns the angles and what is left of each residual (n,), in m and rad: above TOLERANCE, the
    pose was not reached.
    """

    def look(_, angles):
        reached, jacobians = arm.forward_and_jacobian(angles[:, 0])
        return reached[:, None], jacobians[:, None]

    angles, residuals = solve_groups(look, poses[:, None], start[:, None], TOLERANCE, STEPS)
    return angles[:, 0], residuals[:, 0]


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
        reached, jacobians = look(unsolved, angles)
        missing = _missing(reached, goals)
        residuals = np.abs(missing).max(axis=-1)
        better = residuals < least
        best, least = np.where(better[..., None], angles, best), np.where(better, residuals, least)
        goes_on = (least > tolerance).any(axis=1)
        if not goes_on.any():
            break
        if not goes_on.all():
            found[unsolved], left[unsolved] = best, least
            unsolved, goals, angles, best, least, jacobians, missing = (
                each[goes_on] for each in (unsolved, goals, angles, best, least, jacobians, missing)
            )
        turns = _solve_each(jacobians, missing)
        longest = np.abs(turns).max(axis=-1, keepdims=True)
        angles = angles + turns * (LONGEST_STEP / np.maximum(LONGEST_STEP, longest))
    found[unsolved], left[unsolved] = best, least
    return found, left


def _missing(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes the poses `start` (..., 4, 4) to `end`, (..., 6), along the base's axes.

    The translation [m], and the turn as its axis times the sine of its angle [rad], which is the
    angle itself where Newton's method ends.
    """
    between = end[..., :3, :3] @ start[..., :3, :3].swapaxes(-2, -1)
    turns = (between - between.swapaxes(-2, -1))[..., [2, 0, 1], [1, 2, 0]] / 2
    return np.concatenate([end[..., :3, 3] - start[..., :3, 3], turns], axis=-1)


def _solve_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The solutions (..., 6) of linear equations; of a singular one the smallest."""
    try:
        return np.linalg.solve(matrices, vectors[..., None])[..., 0]
    except np.linalg.LinAlgError:  # one of them is exactly singular
        return (np.linalg.pinv(matrices) @ vectors[..., None])[..., 0]
