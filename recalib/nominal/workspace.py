"""Pose coordinates of a workspace, their conversion to and from SE(3), and errors of poses.

A pose is a homogeneous matrix (4, 4) of the tool in the base frame, in metres. Its coordinates are
a 6-vector u: the position (x, y, z) relative to the centre of the workspace along the base's axes,
and three numbers for the orientation relative to that of the centre: (roll, pitch, yaw) of
R = R_centre Rz(yaw) Ry(pitch) Rx(roll), or a rotation vector r of R = R_centre exp([r]). They are
divided by the half-ranges of the workspace. So the workspace is the box [-1, 1]^6, and no norm
mixes metres with radians.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from recalib.arrays import array_of, check_rotations, ending
from recalib.errors import InvalidSetting, check_name
from recalib.nominal import kernels

COORDINATES = "roll_pitch_yaw", "rotation_vector"  # coordinates of orientations
ERRORS = "norm", "coordinates"  # definitions of a pose's errors
POSITION, ORIENTATION = slice(0, 3), slice(3, 6)


@dataclass(frozen=True)
class Workspace:
    """The box of poses in which the robot works.

    Args:
        centre: pose (4, 4) of the box's centre in the base frame, lengths in m.
        half_ranges: (6,) half of the box's size along each coordinate: three lengths in m, three
            angles in rad.
        coordinates: coordinates of orientations: roll_pitch_yaw or rotation_vector.

    Raises UnknownName, and InvalidSetting for another shape, a centre that is no pose, a size that
    is not positive, or a size so large that the coordinates of orientations are ambiguous.
    """

    centre: np.ndarray
    half_ranges: np.ndarray
    coordinates: str = "roll_pitch_yaw"

    def __post_init__(self) -> None:
        check_name("coordinates of orientations", self.coordinates, COORDINATES)
        for name, shape in {"centre": (4, 4), "half_ranges": (6,)}.items():
            object.__setattr__(self, name, array_of(name, getattr(self, name), shape))
        check_rotations("centre", self.centre)
        if not (self.half_ranges > 0).all():
            raise InvalidSetting("half_ranges", self.half_ranges.tolist(), "above 0")
        roll, pitch, yaw = turns = self.half_ranges[ORIENTATION]
        if self.region[2]:
            unique, most = np.linalg.norm(turns) < np.pi, "a diagonal below 180 deg"
        else:
            unique = pitch < np.pi / 2 and max(roll, yaw) < np.pi
            most = "a pitch below 90 deg, roll and yaw below 180 deg"
        if not unique:  # measured coordinates could differ from commanded ones for the same pose
            found = [round(turn, 3) for turn in np.degrees(turns).tolist()]
            raise InvalidSetting("half_ranges of orientation", found, most)

    def to_poses(self, coordinates: np.ndarray) -> np.ndarray:
        """Poses (..., 4, 4) at coordinates (..., 6). Raises InvalidSetting for another shape."""
        coordinates = ending("coordinates", coordinates, 6)
        poses = kernels.poses_at(coordinates.reshape(-1, 6), self.region)
        return poses.reshape(*coordinates.shape[:-1], 4, 4)

    def to_coordinates(self, poses: np.ndarray) -> np.ndarray:
        """Coordinates (..., 6) of poses (..., 4, 4).

        Relative to the centre's orientation, a pitch must be below 90 degrees, a rotation vector
        below 180 degrees. Raises InvalidSetting for another shape.
        """
        poses = ending("poses", poses, 4, 4)
        numbers = kernels.coordinates_of(poses.reshape(-1, 4, 4), self.region)
        return numbers.reshape(*poses.shape[:-2], 6)

    @cached_property
    def region(self) -> tuple[np.ndarray, np.ndarray, bool]:
        """The workspace for compiled loops: see `recalib.nominal.kernels.Region`."""
        return self.centre, self.half_ranges, self.coordinates == "rotation_vector"

    def sample(self, generator: np.random.Generator, *shape: int) -> np.ndarray:
        """Coordinates (*shape, 6) drawn uniformly from the box."""
        return generator.uniform(-1, 1, (*shape, 6))


def position_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Euclidean distance (...) in m between poses (..., 4, 4)."""
    return _distances(achieved, desired)[0]


def orientation_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Angle (...) in rad of the rotation between the orientations of poses (..., 4, 4)."""
    return _distances(achieved, desired)[1]


def _distances(achieved: np.ndarray, desired: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    achieved, desired = ending("achieved", achieved, 4, 4), ending("desired", desired, 4, 4)
    try:
        achieved, desired = np.broadcast_arrays(achieved, desired)
    except ValueError:
        raise InvalidSetting(
            "desired", f"of shape {desired.shape}", f"as many poses as achieved, {achieved.shape}"
        ) from None
    lengths, angles = kernels.distances(achieved.reshape(-1, 4, 4), desired.reshape(-1, 4, 4))
    return lengths.reshape(achieved.shape[:-2]), angles.reshape(achieved.shape[:-2])


def pose_errors(
    workspace: Workspace, achieved: np.ndarray, desired: np.ndarray, error: str = "norm"
) -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and orientation errors [rad], each (...), of poses (..., 4, 4).

    Args:
        error: "norm": Euclidean distance and rotation angle; "coordinates": mean absolute error
            of the three coordinates of position, and of orientation.

    Raises UnknownName.
    """
    check_name("error of a pose", error, ERRORS)
    if error == "norm":
        return _distances(achieved, desired)
    offsets = workspace.to_coordinates(achieved) - workspace.to_coordinates(desired)
    offsets = np.abs(offsets) * workspace.half_ranges
    turns = offsets[..., ORIENTATION]
    turns = np.minimum(turns, 2 * np.pi - turns)  # the shorter way round
    return offsets[..., POSITION].mean(axis=-1), turns.mean(axis=-1)
