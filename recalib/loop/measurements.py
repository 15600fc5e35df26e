"""Checks of a measured pose: one that is none, or grossly off, is refused by name."""

import numpy as np
from numpy.typing import ArrayLike

from recalib.errors import BadMeasurement

FARTHEST = 10.0  # m from where the tool should be: that is no arm, or not in metres
SKEW = 0.01  # of a rotation matrix, as instruments round it
POSE = "a rotation and a position, above a row of 0, 0, 0, 1"


def checked_pose(given: ArrayLike, expected: np.ndarray) -> np.ndarray:
    """A measured pose (4, 4) [m] in the base frame.

    Args:
        given: by the robot.
        expected: (4, 4) likewise, to which it must be near.

    Raises BadMeasurement: it is no pose, or grossly off.
    """
    try:
        measured = np.asarray(given, dtype=float)
    except (TypeError, ValueError):  # something else than numbers
        measured = np.empty(0)
    if measured.shape != (4, 4):
        valid = "a matrix (4, 4)"
    elif not np.isfinite(measured).all():
        valid = "numbers"
    elif not are_poses(measured):
        valid = POSE
    elif np.linalg.norm(measured[:3, 3] - expected[:3, 3]) > FARTHEST:
        valid = f"m in the base frame, at most {FARTHEST:g} m from the workspace's centre"
    else:
        return measured
    raise BadMeasurement("the robot", np.ravel(measured), valid)


def are_poses(matrices: np.ndarray) -> np.ndarray:
    """Whether matrices (..., 4, 4) are poses, (...): none is transposed, mirrored or scaled."""
    turns = matrices[..., :3, :3]
    skew = np.abs(turns @ turns.swapaxes(-2, -1) - np.eye(3)).max(axis=(-2, -1))
    ends = (matrices[..., 3, :] == [0, 0, 0, 1]).all(axis=-1)
    return ends & (skew < SKEW) & (np.linalg.det(turns) > 0)
