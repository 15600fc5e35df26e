"""The postures that were measured: their rows, the joints that never moved, the range of poses.

Poses are compared by their positions, and by their rotation vectors from the mean rotation, along
the principal axes of both.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from recalib.identification.model.frames import nearest_rotation
from recalib.identification.model.linearisation import LEVER

ALIKE = 3.0  # standard deviations of the noise: smaller motions of the target are not noticeable
MARGIN = 0.05  # fraction of the range along an axis: poses less far beyond it count as inside
LEAST = 5e-3, np.radians(1)  # m, rad: the least such margin
TURNED = np.radians(2)  # the least range of turns about an axis that counts as a turn


@dataclass(frozen=True)
class Postures:
    """The postures in which an arm was measured.

    Attributes:
        numbers: (n,) the number of each row's posture, in the order of their first rows.
        still: (joints,) whether a joint never moved.
    """

    numbers: np.ndarray
    still: np.ndarray

    def __len__(self) -> int:
        return int(self.numbers.max()) + 1

    @property
    def first(self) -> np.ndarray:
        """The first row (p,) of each posture."""
        return np.unique(self.numbers, return_index=True)[1]


def find_postures(joints: np.ndarray, slides: np.ndarray, noise: float) -> Postures:
    """The postures in joint coordinates (n, joints) [rad, m], of prismatic or revolute joints.

    Rows are of the same posture if they differ by less than three times the noise [m] along an
    axis, where a turn of one rad counts as `LEVER`. A joint's full turns do not matter.
    """
    radius, moved = ALIKE * noise, np.ptp(joints, axis=0) * np.where(slides, 1.0, LEVER)
    turns = joints[:, ~slides]
    circles = LEVER * np.concatenate([np.cos(turns), np.sin(turns)], axis=1)
    places = np.concatenate([joints[:, slides], circles], axis=1)
    tree, numbers = KDTree(places), np.full(len(places), -1)
    for row, place in enumerate(places):
        if numbers[row] < 0:  # all rows of a posture are near its first row, so they form no chain
            near = np.array(tree.query_ball_point(place, radius))
            numbers[near[numbers[near] < 0]] = numbers.max() + 1
    return Postures(numbers, moved <= radius)


def outside_of(known: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """Distances (n, 2) [m, rad] of poses (n, 4, 4) from the range of known poses (m, 4, 4).

    They are 0 inside the range. The angle of positions (n, 3), without an orientation, is 0.
    """
    found, mean = np.zeros((len(poses), 2)), nearest_rotation(known[:, :3, :3].sum(axis=0))
    places = poses if poses.ndim == 2 else poses[:, :3, 3]
    found[:, 0] = _beyond(known[:, :3, 3], places, LEAST[0])
    if poses.ndim == 3:
        found[:, 1] = _beyond(_turns(known, mean), _turns(poses, mean), LEAST[1])
    return found


def turned_axes(poses: np.ndarray) -> np.ndarray:
    """The axes (k, 3) about which poses (n, 4, 4) turned, in the frame of the poses."""
    turns = _turns(poses, nearest_rotation(poses[:, :3, :3].sum(axis=0)))
    axes = _principal_axes(turns)
    return axes[np.ptp(turns @ axes.T, axis=0) > TURNED]


def _turns(poses: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """Rotation vectors (n, 3) [rad] from a rotation (3, 3) to those of poses (n, 4, 4)."""
    return Rotation.from_matrix(poses[:, :3, :3] @ mean.T).as_rotvec()


def _principal_axes(points: np.ndarray) -> np.ndarray:
    """The axes (3, 3) along which points (n, 3) spread, from most to least."""
    # full matrices complete the axes of fewer than three points, but are huge for many points
    return np.linalg.svd(points - points.mean(axis=0), full_matrices=len(points) < 3).Vh


def _beyond(known: np.ndarray, others: np.ndarray, least: float) -> np.ndarray:
    """Distances (n,) of others (n, 3) from the ranges of the known (m, 3) along principal axes."""
    axes = _principal_axes(known)
    inside, along = known @ axes.T, others @ axes.T
    low, high = inside.min(axis=0), inside.max(axis=0)
    beyond = np.maximum(low - along, along - high)
    return np.linalg.norm(
        np.where(beyond > np.maximum(MARGIN * (high - low), least), beyond, 0.0), axis=1
    )
