"""Inverse kinematics by Newton's method: joint angles that take a tool to poses."""

from collections.abc import Callable

import numpy as np

from recalib.nominal.chain import LAST, NEXT, Chain, blocks, jacobians, to_frames

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch that it starts on

# From the groups (m,) that are asked for and their joint angles (6, m, n) [rad] to the frames
# (3, 4, m, n) [m] of the tool, and a function from those of the groups that are not yet solved, an
# index, to the tool's Jacobians (6, 6, unsolved, n) there.
Linearise = Callable[[np.ndarray | slice], np.ndarray]
Look = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, Linearise]]


def solve_newton(
    chain: Chain, poses: np.ndarray, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (n, 6) [rad] that take the arm's tool to poses, each solved by itself.

    Args:
        chain: of the arm.
        poses: (n, 4, 4) of the tool in the base frame [m].
        start: (n, 6) rad nearby.

    Returns the angles and what is left of each residual (n,), in m and rad: above TOLERANCE, the
    pose was not reached.
    """

    def look(_, angles):
        frames = chain.frames(angles)
        return frames[-1], lambda unsolved: jacobians(frames[..., unsolved, :])

    angles, residuals = np.empty(start.shape), np.empty(len(start))
    for block in blocks(len(start)):
        angles[block, None], residuals[block, None] = solve_groups(
            look, poses[block, None], start[block, None], TOLERANCE, STEPS
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
    unsolved, goals, angles = (
        np.arange(len(poses)),
        to_frames(poses),
        start.transpose(2, 0, 1).copy(),
    )
    best, least = angles, left
    for _ in range(steps):
        reached, linearise = look(unsolved, angles)
        missing = _missing(reached, goals)
        residuals = np.abs(missing).max(axis=0)
        better = residuals < least
        if better.all():
            best, least = angles, residuals
        else:
            best, least = np.where(better, angles, best), np.where(better, residuals, least)
        goes_on = (least > tolerance).any(axis=1)
        if not goes_on.any():
            break
        if goes_on.all():
            goes_on = slice(None)
        else:
            found[unsolved], left[unsolved] = best.transpose(1, 2, 0), least
            unsolved, least = unsolved[goes_on], least[goes_on]
            goals, angles, best, missing = (
                each[..., goes_on, :] for each in (goals, angles, best, missing)
            )
        angles = angles + _turns(linearise(goes_on), missing)
    found[unsolved], left[unsolved] = best.transpose(1, 2, 0), least
    return found, left


def _missing(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes the frames `start` (3, 4, ...) to `end`, (6, ...), along the base's axes.

    The translation [m], and the turn as its axis times the sine of its angle [rad], which is the
    angle itself where Newton's method ends.
    """
    back = np.add.reduce(start[:, None, :3] * end[:, :3], axis=2)  # from the end to the start
    missing = np.empty((6, *start.shape[2:]))
    np.subtract(end[:, 3], start[:, 3], out=missing[:3])
    np.subtract(back[NEXT, LAST], back[LAST, NEXT], out=missing[3:])
    missing[3:] /= 2
    return missing


def _turns(matrices: np.ndarray, missing: np.ndarray) -> np.ndarray:
    """Newton's steps (6, ...) [rad] by Jacobians (6, 6, ...): the smallest of a singular one."""
    matrices = matrices.transpose(2, 3, 0, 1)
    missing = missing.transpose(1, 2, 0)[..., None]
    try:
        turns = np.linalg.solve(matrices, missing)[..., 0]
    except np.linalg.LinAlgError:  # one of them is exactly singular
        turns = (np.linalg.pinv(matrices) @ missing)[..., 0]
    turns = turns.transpose(2, 0, 1).copy()
    longest = np.abs(turns).max(axis=0)
    if longest.max() > LONGEST_STEP:
        turns = turns * (LONGEST_STEP / np.maximum(LONGEST_STEP, longest))
    return turns
