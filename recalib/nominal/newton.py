"""Newton's method for inverse kinematics, given a function for poses and Jacobians."""

from collections.abc import Callable

import numpy as np

from recalib.nominal.kernels import LONGEST_STEP as LONGEST_STEP
from recalib.nominal.kernels import SINGULAR

# Of x, y and z the two others, in a circle.
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])

# From the groups (m,) that are asked for and their joint angles (m, n, joint) [rad] to the poses
# (m, n, 4, 4) [m] of the tool and its Jacobians (m, n, 6, joint) there.
Kinematics = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def solve_groups(
    kinematics: Kinematics, goals: np.ndarray, start: np.ndarray, tolerance: float, steps: int
) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (group, n, joint) [rad] that take tools to goals, and their errors (group, n).

    With more joints than a goal has numbers, each step is the shortest; with fewer, the one that
    leaves least. A group is solved when all of its goals are; where one is not, its best angles are
    kept. An error is the largest number of a residual; with fewer joints than numbers, its norm.

    Args:
        goals: poses (group, n, 4, 4) or positions (group, n, 3) m.
        start: (group, n, joint) rad nearby.
        tolerance: of errors, in m and rad.
        steps: at most so many.
    """
    found, error = start.copy(), np.full(start.shape[:2], np.inf)
    unsolved, angles, best, least = np.arange(len(goals)), start, found, error
    for _ in range(steps):
        reached, jacobians = kinematics(unsolved, angles)
        residual = _residual(reached, goals)
        few = start.shape[-1] < residual.shape[-1]  # then the steps make squares least
        errors = np.linalg.norm(residual, axis=-1) if few else np.abs(residual).max(axis=-1)
        better = errors < least
        best = np.where(better[..., None], angles, best)
        least = np.where(better, errors, least)
        goes_on = (least > tolerance).any(axis=1)
        if not goes_on.any():
            break
        if not goes_on.all():
            found[unsolved], error[unsolved] = best, least
            unsolved, goals, angles, best, least, jacobians, residual = (
                array[goes_on]
                for array in (unsolved, goals, angles, best, least, jacobians, residual)
            )
        step = _solve_each(jacobians[..., : residual.shape[-1], :], residual)
        longest = np.abs(step).max(axis=-1, keepdims=True)
        step *= LONGEST_STEP / np.maximum(LONGEST_STEP, longest)
        angles = angles + step
    found[unsolved], error[unsolved] = best, least
    return found, error


def _residual(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes the poses `start` (..., 3 or 4, 4) to `end`, along the base's axes.

    The translation (..., 3) [m] and, unless `end` are positions (..., 3), the turn (..., 6) [rad]
    as its axis times the sine of its angle, which is the angle itself where Newton's method ends.
    Beyond a right angle it is the angle, or half a turn would count as none.
    """
    if end.ndim < start.ndim:
        return end - start[..., :3, 3]
    between = end[..., :3, :3] @ start[..., :3, :3].swapaxes(-2, -1)
    residual = np.empty((*between.shape[:-2], 6))
    residual[..., :3] = end[..., :3, 3] - start[..., :3, 3]
    residual[..., 3:] = (between - between.swapaxes(-2, -1))[..., LAST, NEXT] / 2
    far = np.trace(between, axis1=-2, axis2=-1) < 1
    if far.any():
        from scipy.spatial.transform import Rotation  # seldom needed: no start waits for it

        residual[far, 3:] = Rotation.from_matrix(between[far]).as_rotvec()
    return residual


def _solve_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The solutions (..., joint) of linear equations; of what has no or many the smallest."""
    if matrices.shape[-1] != matrices.shape[-2]:
        return (np.linalg.pinv(matrices, rcond=1 / SINGULAR) @ vectors[..., None])[..., 0]
    try:
        solutions = np.linalg.solve(matrices, vectors[..., None])[..., 0]
    except np.linalg.LinAlgError:  # one of them is exactly singular
        solutions = np.full(vectors.shape, np.inf)
    longest = np.abs(solutions).max(axis=-1)
    if (singular := longest > SINGULAR).any():
        inverses = np.linalg.pinv(matrices[singular], rcond=1 / SINGULAR)
        solutions[singular] = (inverses @ vectors[singular][..., None])[..., 0]
    return solutions
