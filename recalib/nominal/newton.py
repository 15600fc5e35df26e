"""Newton's method for inverse kinematics, given a function that returns poses and Jacobians."""

from collections.abc import Callable

import numpy as np
import scipy  # loads its subpackages, which are slow to import, at their first use

from recalib.nominal.kernels import LONGEST_STEP as LONGEST_STEP
from recalib.nominal.kernels import SINGULAR

# The two other axes of x, y and z, in cyclic order.
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])

# Takes indices of groups (m,) and their joint angles (m, n, joint) [rad]; returns the tool's poses
# (m, n, 4, 4) [m] and Jacobians (m, n, 6, joint).
Kinematics = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def solve_groups(
    kinematics: Kinematics, goals: np.ndarray, start: np.ndarray, tolerance: float, steps: int
) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (group, n, joint) [rad] that take tools to goals, and their errors (group, n).

    With more joints than components of a goal, each step is the shortest; with fewer, it minimises
    the residual. A group is solved when all of its goals are solved; for an unsolved goal, the best
    angles are returned. An error is the residual's largest component or, with fewer joints, norm.

    Args:
        goals: poses (group, n, 4, 4) or positions (group, n, 3) m.
        start: (group, n, joint) rad, initial estimates.
        tolerance: greatest accepted error, in m and rad.
        steps: maximum number of steps.
    """
    found, error = start.copy(), np.full(start.shape[:2], np.inf)
    unsolved, angles, best, least = np.arange(len(goals)), start, found, error
    for _ in range(steps):
        reached, jacobians = kinematics(unsolved, angles)
        residual = _residual(reached, goals)
        few = start.shape[-1] < residual.shape[-1]  # then the steps minimise the sum of squares
        errors = np.linalg.norm(residual, axis=-1) if few else np.abs(residual).max(axis=-1)
        better = errors < least
        best = np.where(better[..., None], angles, best)
        least = np.where(better, errors, least)
        remaining = (least > tolerance).any(axis=1)
        if not remaining.any():
            break
        if not remaining.all():
            found[unsolved], error[unsolved] = best, least
            unsolved, goals, angles, best, least, jacobians, residual = (
                array[remaining]
                for array in (unsolved, goals, angles, best, least, jacobians, residual)
            )
        step = _solve_each(jacobians[..., : residual.shape[-1], :], residual)
        longest = np.abs(step).max(axis=-1, keepdims=True)
        step *= LONGEST_STEP / np.maximum(LONGEST_STEP, longest)
        angles = angles + step
    found[unsolved], error[unsolved] = best, least
    return found, error


def _residual(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """The motion (..., 3 or 6) from poses `start` (..., 3 or 4, 4) to `end`, along the base's axes.

    It is the translation [m] and, unless `end` are positions (..., 3), the rotation [rad]: its axis
    times the sine of its angle, which equals the angle near the solution. Beyond 90 degrees the
    angle itself is used, because the sine of 180 degrees is zero.
    """
    if end.ndim < start.ndim:
        return end - start[..., :3, 3]
    between = end[..., :3, :3] @ start[..., :3, :3].swapaxes(-2, -1)
    residual = np.empty((*between.shape[:-2], 6))
    residual[..., :3] = end[..., :3, 3] - start[..., :3, 3]
    residual[..., 3:] = (between - between.swapaxes(-2, -1))[..., LAST, NEXT] / 2
    far = np.trace(between, axis1=-2, axis2=-1) < 1
    if far.any():
        residual[far, 3:] = scipy.spatial.transform.Rotation.from_matrix(between[far]).as_rotvec()
    return residual


def _solve_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The solutions (..., joint) of linear equations; if singular, by the pseudoinverse."""
    if matrices.shape[-1] != matrices.shape[-2]:
        return (np.linalg.pinv(matrices, rcond=1 / SINGULAR) @ vectors[..., None])[..., 0]
    try:
        solutions = np.linalg.solve(matrices, vectors[..., None])[..., 0]
    except np.linalg.LinAlgError:  # at least one matrix is exactly singular
        solutions = np.full(vectors.shape, np.inf)
    longest = np.abs(solutions).max(axis=-1)
    if (singular := longest > SINGULAR).any():
        inverses = np.linalg.pinv(matrices[singular], rcond=1 / SINGULAR)
        solutions[singular] = (inverses @ vectors[singular][..., None])[..., 0]
    return solutions
