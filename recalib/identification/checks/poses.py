"""Where poses were measured: how far others lie outside, and about which axes a tool never turned.

Positions, and rotation vectors from the mean rotation, are compared along their principal axes.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.frames import nearest_rotation

MARGIN = 0.05  # of the range along an axis: what lies less far beyond it is inside
LEAST = 5e-3, np.radians(1)  # m, rad: likewise
TURNED = np.radians(2)  # about an axis, by all rows together: less is no turn


def outside_of(known: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """How far (n, 2) [m, rad] poses are from where others were measured; 0 inside.

    Args:
        known: (m, 4, 4) m, those that were measured.
        poses: (n, 4, 4) m, or positions (n, 3), which are turned as it may be.
    """
    found, mean = np.zeros((len(poses), 2)), nearest_rotation(known[:, :3, :3].sum(axis=0))
    places = poses if poses.ndim == 2 else poses[:, :3, 3]
    found[:, 0] = _beyond(known[:, :3, 3], places, LEAST[0])
    if poses.ndim == 3:
        found[:, 1] = _beyond(_turns(known, mean), _turns(poses, mean), LEAST[1])
    return found


def turned_axes(poses: np.ndarray) -> np.ndarray:
    """The axes (k, 3) in the frame of poses (n, 4, 4) about which these turned."""
    turns = _turns(poses, nearest_rotation(poses[:, :3, :3].sum(axis=0)))
    axes = np.linalg.svd(turns - turns.mean(axis=0)).Vh
    return axes[np.ptp(turns @ axes.T, axis=0) > TURNED]


def _turns(poses: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """Rotation vectors (n, 3) [rad] from a rotation (3, 3) to those of poses (n, 4, 4)."""
    return Rotation.from_matrix(poses[:, :3, :3] @ mean.T).as_rotvec()


def _beyond(known: np.ndarray, others: np.ndarray, least: float) -> np.ndarray:
    """How far others (n, 3) are beyond the ranges of the known (m, 3) along their axes."""
    axes = np.linalg.svd(known - known.mean(axis=0), full_matrices=True).Vh
    own, along = known @ axes.T, others @ axes.T
    low, high = own.min(axis=0), own.max(axis=0)
    beyond = np.maximum(low - along, along - high)
    return np.linalg.norm(
        np.where(beyond > np.maximum(MARGIN * (high - low), least), beyond, 0.0), axis=1
    )
