"""Measurements as they enter: what nobody can learn from is refused by its name.

One number that is none would spread, in silence, through all that is learned from it; and so would
millimetres that are taken for metres.
"""

import numpy as np

from recalib.errors import BadMeasurement

FARTHEST = 10.0  # m from where the tool should be: that is no arm, or not in metres
WIDEST = 1e5  # workspace coordinates, likewise
SKEW = 0.01  # of a rotation matrix, as instruments round it


def check_coordinates(achieved: np.ndarray) -> None:
    """Raise BadMeasurement unless coordinates (run, move, 6) are numbers, and not grossly off.

    Refused moves count, too: they leave the arm at home.
    """
    if np.abs(achieved).max(initial=0.0) <= WIDEST:  # not so where one is NaN
        return
    run, move = np.argwhere(~(np.abs(achieved) <= WIDEST).all(axis=-1))[0]
    valid = f"six coordinates of the workspace, each a number up to {WIDEST:g}"
    raise BadMeasurement(f"move {move} of run {run}", achieved[run, move], valid)


def check_pose(measured: np.ndarray, near: np.ndarray) -> None:
    """Raise BadMeasurement unless a measured pose is one, and not grossly off.

    Args:
        measured: (4, 4) m in the base frame, if it is as it should be.
        near: (4, 4) likewise, to which it must be near.
    """
    if np.shape(measured) != (4, 4):
        valid = "a matrix (4, 4)"
    elif not np.isfinite(measured).all():
        valid = "numbers"
    elif not _is_rotation(measured) or not np.array_equal(measured[3], [0, 0, 0, 1]):
        valid = "a rotation and a position, above a row of 0, 0, 0, 1"
    elif np.linalg.norm(measured[:3, 3] - near[:3, 3]) > FARTHEST:
        valid = f"m in the base frame, at most {FARTHEST:g} m from the workspace's centre"
    else:
        return
    raise BadMeasurement("the robot", np.ravel(measured), valid)


def _is_rotation(pose: np.ndarray) -> bool:
    turn = pose[:3, :3]
    return np.abs(turn @ turn.T - np.eye(3)).max() < SKEW and np.linalg.det(turn) > 0
