"""Pose coordinates of a workspace and their conversion to and from SE(3), and the two errors.

A pose is a homogeneous matrix (4, 4) of the tool in the base frame, in metres. Its coordinates are
the 6-vector u = (x, y, z, roll, pitch, yaw): the position relative to the centre of the workspace
along the base's axes, and the orientation relative to that of the centre,
R = R_centre Rz(yaw) Ry(pitch) Rx(roll). They are divided by the half-ranges of the workspace, so
that the workspace is the box [-1, 1]^6 and no norm mixes metres with radians.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

COORDINATES = ("x", "y", "z", "roll", "pitch", "yaw")
POSITION, ORIENTATION = slice(0, 3), slice(3, 6)


@dataclass(frozen=True)
class Workspace:
    """The box of poses in which the robot works.

    Args:
        centre: pose (4, 4) of the box's centre in the base frame, lengths in m.
        half_ranges: (6,) half of the box's size along each coordinate: three lengths in m, three
            angles in rad.
    """

    centre: np.ndarray
    half_ranges: np.ndarray

    def to_poses(self, coordinates: np.ndarray) -> np.ndarray:
        """Poses (..., 4, 4) at the coordinates (..., 6)."""
        raw = coordinates * self.half_ranges
        poses = np.empty((*coordinates.shape[:-1], 4, 4))
        relative = Rotation.from_euler("xyz", raw[..., ORIENTATION].reshape(-1, 3)).as_matrix()
        poses[..., :3, :3] = (self.centre[:3, :3] @ relative).reshape(poses[..., :3, :3].shape)
        poses[..., :3, 3] = self.centre[:3, 3] + raw[..., POSITION]
        poses[..., 3, :] = 0, 0, 0, 1
        return poses

    def to_coordinates(self, poses: np.ndarray) -> np.ndarray:
        """Coordinates (..., 6) of the poses (..., 4, 4).

        Their pitch must stay below 90 degrees from the centre's.
        """
        coordinates = np.empty((*poses.shape[:-2], 6))
        coordinates[..., POSITION] = poses[..., :3, 3] - self.centre[:3, 3]
        relative = (self.centre[:3, :3].T @ poses[..., :3, :3]).reshape(-1, 3, 3)
        angles = Rotation.from_matrix(relative, assume_valid=True).as_euler("xyz")
        coordinates[..., ORIENTATION] = angles.reshape(coordinates[..., ORIENTATION].shape)
        return coordinates / self.half_ranges

    def sample(self, generator: np.random.Generator, *shape: int) -> np.ndarray:
        """Coordinates (*shape, 6) drawn uniformly from the box."""
        return generator.uniform(-1, 1, (*shape, 6))


def position_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Euclidean distance (...) in m between poses (..., 4, 4)."""
    return np.linalg.norm(achieved[..., :3, 3] - desired[..., :3, 3], axis=-1)


def orientation_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Angle (...) in rad of the turn from one orientation to the other, of poses (..., 4, 4)."""
    between = np.swapaxes(desired[..., :3, :3], -1, -2) @ achieved[..., :3, :3]
    angles = Rotation.from_matrix(between.reshape(-1, 3, 3), assume_valid=True).magnitude()
    return angles.reshape(between.shape[:-2])
