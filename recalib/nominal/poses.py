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

from recalib.errors import InvalidSetting, UnknownName
from recalib.numerics.compiled import compiled

COORDINATES = "roll_pitch_yaw", "rotation_vector"  # of orientations
ERRORS = "norm", "coordinates"  # of a pose
POSITION, ORIENTATION = slice(0, 3), slice(3, 6)


@dataclass(frozen=True)
class Workspace:
    """The box of poses in which the robot works.

    Args:
        centre: pose (4, 4) of the box's centre in the base frame, lengths in m.
        half_ranges: (6,) half of the box's size along each coordinate: three lengths in m, three
            angles in rad.
        coordinates: of orientations: roll_pitch_yaw or rotation_vector.

    Raises UnknownName, and InvalidSetting where orientations in it have several coordinates.
    """

    centre: np.ndarray
    half_ranges: np.ndarray
    coordinates: str = "roll_pitch_yaw"

    def __post_init__(self) -> None:
        if self.coordinates not in COORDINATES:
            raise UnknownName("coordinates of orientations", self.coordinates, COORDINATES)
        roll, pitch, yaw = turns = np.abs(self.half_ranges[ORIENTATION])
        if self._vectors:
            unique, most = np.linalg.norm(turns) < np.pi, "a diagonal below 180 deg"
        else:
            unique = pitch < np.pi / 2 and max(roll, yaw) < np.pi
            most = "a pitch below 90 deg, roll and yaw below 180 deg"
        if not unique:  # other coordinates would come back than were commanded
            found = [round(turn, 3) for turn in np.degrees(turns).tolist()]
            raise InvalidSetting("half_ranges of orientation", found, most)

    def to_poses(self, coordinates: np.ndarray) -> np.ndarray:
        """Poses (..., 4, 4) at the coordinates (..., 6)."""
        poses = _poses(coordinates.reshape(-1, 6), self.centre, self.half_ranges, self._vectors)
        return poses.reshape(*coordinates.shape[:-1], 4, 4)

    def to_coordinates(self, poses: np.ndarray) -> np.ndarray:
        """Coordinates (..., 6) of the poses (..., 4, 4).

        From the centre's orientation, a pitch must stay below 90 degrees, a turn below 180.
        """
        numbers = _coordinates(
            poses.reshape(-1, 4, 4), self.centre, self.half_ranges, self._vectors
        )
        return numbers.reshape(*poses.shape[:-2], 6)

    @property
    def _vectors(self) -> bool:
        return self.coordinates == "rotation_vector"

    def sample(self, generator: np.random.Generator, *shape: int) -> np.ndarray:
        """Coordinates (*shape, 6) drawn uniformly from the box."""
        return generator.uniform(-1, 1, (*shape, 6))


# What follows is compiled, since a robot's every move needs both. SciPy's `Rotation`, which spends
# most of its time on what is no arithmetic, says in the tests what they are to return.


@compiled
def _poses(
    coordinates: np.ndarray, centre: np.ndarray, half_ranges: np.ndarray, vectors: bool
) -> np.ndarray:
    poses = np.zeros((len(coordinates), 4, 4))
    relative = np.empty((3, 3))
    for index in range(len(coordinates)):
        numbers, pose = coordinates[index] * half_ranges, poses[index]
        if vectors:
            _write_turn_by_vector(numbers[3:], relative)
        else:
            _write_turn_by_angles(numbers[3:], relative)
        _write_product(centre, relative, pose)
        for row in range(3):
            pose[row, 3] = centre[row, 3] + numbers[row]
        pose[3, 3] = 1
    return poses


@compiled
def _coordinates(
    poses: np.ndarray, centre: np.ndarray, half_ranges: np.ndarray, vectors: bool
) -> np.ndarray:
    coordinates, relative = np.empty((len(poses), 6)), np.empty((3, 3))
    for index in range(len(poses)):
        pose, numbers = poses[index], coordinates[index]
        for row in range(3):
            numbers[row] = pose[row, 3] - centre[row, 3]
        _write_product(centre.T, pose, relative)
        if vectors:
            _write_vector(relative, numbers[3:])
        else:
            numbers[3] = np.arctan2(relative[2, 1], relative[2, 2])
            numbers[4] = np.arctan2(-relative[2, 0], np.hypot(relative[0, 0], relative[1, 0]))
            numbers[5] = np.arctan2(relative[1, 0], relative[0, 0])
        numbers /= half_ranges
    return coordinates


@compiled
def _write_product(one: np.ndarray, other: np.ndarray, product: np.ndarray) -> None:
    """Of two orientations, each the first three rows and columns."""
    for row in range(3):
        for column in range(3):
            product[row, column] = (
                one[row, 0] * other[0, column]
                + one[row, 1] * other[1, column]
                + one[row, 2] * other[2, column]
            )


@compiled
def _write_row(row: np.ndarray, x: float, y: float, z: float) -> None:
    row[0], row[1], row[2] = x, y, z


@compiled
def _write_turn_by_angles(angles: np.ndarray, turn: np.ndarray) -> None:
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (a, b, c), (d, e, f) = np.cos(angles), np.sin(angles)
    _write_row(turn[0], c * b, c * e * d - f * a, c * e * a + f * d)
    _write_row(turn[1], f * b, f * e * d + c * a, f * e * a - c * d)
    _write_row(turn[2], -e, b * d, b * a)


@compiled
def _write_turn_by_vector(vector: np.ndarray, turn: np.ndarray) -> None:
    """exp([r]), by Rodrigues' formula."""
    x, y, z = vector
    angle = np.sqrt(x * x + y * y + z * z)
    part = np.sin(angle) / angle if angle > 0 else 1.0
    _write_row(turn[0], 0.0, -part * z, part * y)
    _write_row(turn[1], part * z, 0.0, -part * x)
    _write_row(turn[2], -part * y, part * x, 0.0)
    half = np.sin(angle / 2) / (angle / 2) if angle > 0 else 1.0
    for row in range(3):
        turn[row, row] += np.cos(angle)
        for column in range(3):
            turn[row, column] += half**2 / 2 * vector[row] * vector[column]


@compiled
def _write_vector(turn: np.ndarray, vector: np.ndarray) -> None:
    """Of exp([r]), by its quaternion: of four ways to it, one divides by no small number."""
    trace = turn[0, 0] + turn[1, 1] + turn[2, 2]
    first = int(np.argmax(np.array([turn[0, 0], turn[1, 1], turn[2, 2], trace])))
    if first == 3:
        real = 1 + trace
        for axis in range(3):
            one, other = (axis + 1) % 3, (axis + 2) % 3
            vector[axis] = turn[other, one] - turn[one, other]
    else:
        one, other = (first + 1) % 3, (first + 2) % 3
        real = turn[other, one] - turn[one, other]
        vector[first] = 1 - trace + 2 * turn[first, first]
        vector[one] = turn[one, first] + turn[first, one]
        vector[other] = turn[other, first] + turn[first, other]
    length = np.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    angle = 2 * np.arctan2(length, abs(real))
    vector *= np.copysign(angle / length if length > 0 else 1.0, real)


def position_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Euclidean distance (...) in m between poses (..., 4, 4)."""
    return np.linalg.norm(achieved[..., :3, 3] - desired[..., :3, 3], axis=-1)


def orientation_error(achieved: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """Angle (...) in rad of the turn from one orientation to the other, of poses (..., 4, 4)."""
    from scipy.spatial.transform import Rotation  # no robot that is only asked waits for it

    between = np.swapaxes(desired[..., :3, :3], -1, -2) @ achieved[..., :3, :3]
    angles = Rotation.from_matrix(between.reshape(-1, 3, 3), assume_valid=True).magnitude()
    return angles.reshape(between.shape[:-2])


def pose_errors(
    workspace: Workspace, achieved: np.ndarray, desired: np.ndarray, error: str = "norm"
) -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and orientation errors [rad], each (...), of poses (..., 4, 4).

    Args:
        error: "norm": Euclidean distance, and angle of the turn; "coordinates": means of the
            absolute errors of the three coordinates of each.

    Raises UnknownName.
    """
    if error not in ERRORS:
        raise UnknownName("error of a pose", error, ERRORS)
    if error == "norm":
        return position_error(achieved, desired), orientation_error(achieved, desired)
    offsets = workspace.to_coordinates(achieved) - workspace.to_coordinates(desired)
    offsets = np.abs(offsets) * workspace.half_ranges
    turns = offsets[..., ORIENTATION]
    turns = np.minimum(turns, 2 * np.pi - turns)  # the shorter way round
    return offsets[..., POSITION].mean(axis=-1), turns.mean(axis=-1)
