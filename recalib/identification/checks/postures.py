"""Where an arm was measured: which rows share a posture, what stood still, what lies outside.

Poses are compared by their positions, and their rotation vectors from the mean rotation, along the
principal axes of these.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from recalib.identification.model.frames import nearest_rotation
from recalib.identification.model.linearisation import LEVER

ALIKE = 3.0  # standard deviations of the noise: less moves no target noticeably
MARGIN = 0.05  # of the range along an axis: what lies less far beyond it is inside
LEAST = 5e-3, np.radians(1)  # m, rad: likewise
TURNED = np.radians(2)  # about an axis, by all rows together: less is no turn


@dataclass(frozen=True)
class Postures:
    """The postures in which an arm was measured.

    Attributes:
        numbers: (n,) of the posture of each row, in the order in which they come first.
        still: (joints,) whether a joint never moved.
    """

    numbers: np.ndarray
    still: np.ndarray

    def __len__(self) -> int:
        return int(self.numbers.max()) + 1

    @property
    def first(self) -> np.ndarray:
        """The row (p,) in which each posture comes first."""
        return np.unique(self.numbers, return_index=True)[1]


def find_postures(joints: np.ndarray, slides: np.ndarray, noise: float) -> Postures:
    """The postures in joint coordinates (n, joints) [rad, m], of joints that slide or turn.

    What moves the tool by less than three times the noise [m] along an axis is the same posture,
    where a turn of one rad counts as `LEVER`. So is a joint's next full turn.
    """
    radius, moved = ALIKE * noise, np.ptp(joints, axis=0) * np.where(slides, 1.0, LEVER)
    turns = joints[:, ~slides]
    circles = LEVER * np.concatenate([np.cos(turns), np.sin(turns)], axis=1)
    places = np.concatenate([joints[:, slides], circles], axis=1)
    tree, numbers = KDTree(places), np.full(len(places), -1)
    for row, place in enumerate(places):
        if numbers[row] < 0:  # a posture is no chain: all its rows are near the first of them
            alike = np.array(tree.query_ball_point(place, radius))
            numbers[alike[numbers[alike] < 0]] = numbers.max() + 1
    return Postures(numbers, moved <= radius)


def outside_of(known: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """How far (n, 2) [m, rad] poses (n, 4, 4) are from where the known (m, 4, 4) are; 0 inside.

    Of positions (n, 3), whose orientations do not matter, the angle is 0.
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
    axes = _principal_axes(turns)
    return axes[np.ptp(turns @ axes.T, axis=0) > TURNED]


def _turns(poses: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """Rotation vectors (n, 3) [rad] from a rotation (3, 3) to those of poses (n, 4, 4)."""
    return Rotation.from_matrix(poses[:, :3, :3] @ mean.T).as_rotvec()


def _principal_axes(points: np.ndarray) -> np.ndarray:
    """The axes (3, 3) along which points (n, 3) spread, from most to least."""
    # the full matrices of many points would be huge; those of fewer than three lack axes otherwise
    return np.linalg.svd(points - points.mean(axis=0), full_matrices=len(points) < 3).Vh


def _beyond(known: np.ndarray, others: np.ndarray, least: float) -> np.ndarray:
    """How far others (n, 3) are beyond the ranges of the known (m, 3) along their axes."""
    axes = _principal_axes(known)
    own, along = known @ axes.T, others @ axes.T
    low, high = own.min(axis=0), own.max(axis=0)
    beyond = np.maximum(low - along, along - high)
    return np.linalg.norm(
        np.where(beyond > np.maximum(MARGIN * (high - low), least), beyond, 0.0), axis=1
    )
