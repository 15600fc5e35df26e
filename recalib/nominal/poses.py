"""Pose coordinates of a workspace and their conversion to and from SE(3), and the two errors.

A pose is a homogeneous matrix (4, 4) of the tool in the base frame, in metres. Its coordinates are
a 6-vector u: the position (x, y, z) relative to the centre of the workspace along the base's axes,
and three numbers for the orientation relative to that of the centre: (roll, pitch, yaw) of
R = R_centre Rz(yaw) Ry(pitch) Rx(roll), or a rotation vector r of R = R_centre exp([r]). They are
divided by the half-ranges of the workspace, so that the workspace is the box [-1, 1]^6 and no norm
mixes metres with radians.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import UnknownName

# From three numbers for an orientation to it, and back.
COORDINATES = {
    "roll_pitch_yaw": (
        lambda angles: Rotation.from_euler("xyz", angles),
        lambda rotation: rotation.as_euler("xyz"),
    ),
    "rotation_vector": (Rotation.from_rotvec, Rotation.as_rotvec),
}
POSITION, ORIENTATION = slice(0, 3), slice(3, 6)


@dataclass(frozen=True)
class Workspace:
    """The box of poses in which the robot works.

    Args:
        centre: pose (4, 4) of the box's centre in the base frame, lengths in m.
        half_ranges: (6,) half of the box's size along each coordinate: three lengths in m, three
            angles in rad.
        coordinates: of orientations: roll_pitch_yaw or rotation_vector.

    Raises UnknownName.
    """

    centre: np.ndarray
    half_ranges: np.ndarray
    coordinates: str = "roll_pitch_yaw"

    def __post_init__(self):
        if self.coordinates not in COORDINATES:
            raise UnknownName("coordinates of orientations", self.coordinates, COORDINATES)

    def to_poses(self, coordinates: np.ndarray) -> np.ndarray:
        """Poses (..., 4, 4) at the coordinates (..., 6)."""
        turn, _ = COORDINATES[self.coordinates]
        raw = coordinates * self.half_ranges
        poses = np.empty((*coordinates.shape[:-1], 4, 4))
        relative = turn(raw[..., ORIENTATION].reshape(-1, 3)).as_matrix()
        poses[..., :3, :3] = (self.centre[:3, :3] @ relative).reshape(poses[..., :3, :3].shape)
        poses[..., :3, 3] = self.centre[:3, 3] + raw[..., POSITION]
        poses[..., 3, :] = 0, 0, 0, 1
        return poses

    def to_coordinates(self, poses: np.ndarray) -> np.ndarray:
        """Coordinates (..., 6) of the poses (..., 4, 4).

        From the centre's orientation, a pitch must stay below 90 degrees, a turn below 180.
        """
        _, numbers = COORDINATES[self.coordinates]
        coordinates = np.empty((*poses.shape[:-2], 6))
        coordinates[..., POSITION] = poses[..., :3, 3] - self.centre[:3, 3]
        relative = (self.centre[:3, :3].T @ poses[..., :3, :3]).reshape(-1, 3, 3)
        angles = numbers(Rotation.from_matrix(relative, assume_valid=True))
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
