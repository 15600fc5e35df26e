"""What was measured of an arm, read from a table; docs/own_arm.md describes its columns."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile, InvalidSetting, UnsuitableRobot
from recalib.files.quantities import ANGLE, LENGTH, TIME, Quantity
from recalib.identification.checks.diagnostics import FEWEST
from recalib.laboratory.tables.columns import FAKE, NUMBER, Table, read_table, table_of
from recalib.laboratory.tables.description import Description
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted, listed

POSITION = "x", "y", "z"
NOMINAL = "x_nominal", "y_nominal", "z_nominal"
MISSED = "x_missed", "y_missed", "z_missed"  # measured minus nominal, in place of x, y, z
QUATERNION = "qx", "qy", "qz", "qw"
ROTATIONS = {QUATERNION: NUMBER, ("rx", "ry", "rz"): ANGLE, ("roll", "pitch", "yaw"): ANGLE}
DESIRED = {POSITION: LENGTH} | ROTATIONS
VECTORS = DESIRED | {NOMINAL: LENGTH, MISSED: LENGTH}
OBSERVED = "measurements.csv"  # the table in a folder that `recalib observe` wrote
PICTURE = "picture"  # the column with the names of files, which says nothing of an arm
SENT = [heading.split()[0] for heading in FAKE]  # nor do commands, where they were measured at
TARGET, TIMES = "target", "time"
LABELS = TARGET, "socket"
MEASURED = [*(name for group in VECTORS for name in group), *LABELS, TIMES, PICTURE]
SKEW = 0.01  # of a quaternion's length, as instruments round it
COPIES = 0.1  # of the rows, at most: no instrument repeats itself so often to the last digit
STILL = 1e-3  # rad, m: a joint that moves less could as well be held by its brake
Vectors = Mapping[tuple[str, ...], np.ndarray | None]


@dataclass(frozen=True)
class Measurements:
    """Rows of a table, in SI units.

    Attributes:
        count: n, how many there are.
        coordinates: (n, joints) rad, or m where a joint slides, that the controller reported.
        positions: (n, 3) m of a target in the instrument's frame; None where there are none.
        rotations: (n, 3, 3) of the target in the instrument's frame; None likewise.
        nominal: (n, 3) m, where the positions should have been; None likewise.
        targets: (n,) names of the targets that were measured, the same everywhere if there is one.
        sockets: (n,) names of the sockets in which the ball sat; None where there are none.
        times: (n,) s, when rows were measured; None where there are none.
    """

    count: int
    coordinates: np.ndarray | None = None
    positions: np.ndarray | None = None
    rotations: np.ndarray | None = None
    nominal: np.ndarray | None = None
    targets: np.ndarray | None = None
    sockets: np.ndarray | None = None
    times: np.ndarray | None = None

    def __len__(self) -> int:
        return self.count

    @property
    def joints(self) -> np.ndarray:
        """The joint coordinates (n, joints) of rows that have them. Raises InvalidSetting."""
        if self.coordinates is None:
            raise InvalidSetting("joint coordinates", None, "those of each joint in each row")
        return self.coordinates

    @property
    def measured(self) -> np.ndarray | None:
        """Poses (n, 4, 4) or positions (n, 3) [m] of targets; None where there are neither."""
        if self.rotations is None:
            return self.positions
        poses = np.tile(np.eye(4), (self.count, 1, 1))
        poses[:, :3, :3], poses[:, :3, 3] = self.rotations, self.positions
        return poses


def read_measurements(
    path: str | PathLike[str], arm: Arm, description: Description | None = None
) -> Measurements:
    """The measurements of an arm in the table at `path`.

    Raises InvalidFile: no such table; a column that is missing, unknown, in another unit, there
    twice or useless; a cell that is no number or too large for an arm; too few rows; nothing
    measured; rows pasted twice. UnsuitableRobot: a joint that is called as a column of
    measurements.
    """
    _check_names(arm)
    table = read_table(path, description.columns if description else None)
    read = _read(table, arm)
    if read.coordinates is None:
        raise InvalidFile(path, _lacking(arm, arm.joints[0]))
    if len(read) < FEWEST:
        raise InvalidFile(path, f"it has {counted(len(read), 'row')}; expected: at least {FEWEST}")
    if read.positions is None and read.sockets is None:
        raise InvalidFile(path, "nothing was measured in it; expected: x, y, z or socket")
    if read.positions is not None and read.sockets is not None:
        raise InvalidFile(path, "it has both positions and sockets; expected: one of them")
    if (np.ptp(read.coordinates, axis=0) < STILL).all():
        raise InvalidFile(path, "no joint moves in it; expected: rows of different postures")
    _check_copies(table)
    return read


def read_desired(path: str | PathLike[str], arm: Arm, in_instrument: bool = False) -> Measurements:
    """Desired joint coordinates, poses or positions of the tool in the arm's base, or both.

    Args:
        in_instrument: the poses or positions are those of targets in the instrument's frame.

    Raises InvalidFile as `read_measurements` does, but one row is enough; where a column says
    nothing of what is desired; and where rows are commands, which are corrected already.
    """
    _check_names(arm)
    table = read_table(path)
    if TARGET in table and not in_instrument:
        raise InvalidFile(path, f"column {TARGET!r} needs recalib correct --frame instrument")
    if SENT[0] in table:
        raise InvalidFile(path, "its commands are corrected already; expected: desired poses")
    desired = [name for group in DESIRED for name in group]
    table.check_columns([*arm.joints, *desired, *[TARGET] * in_instrument, PICTURE], _moved_by(arm))
    read = _read(table, arm)
    if read.coordinates is None and read.positions is None:
        raise InvalidFile(path, f"it has neither x, y, z nor joints; expected: {_columns(arm)}")
    return read


def measurements_so_far(
    content: bytes, path: str | PathLike[str], arm: Arm, description: Description
) -> Measurements:
    """The measurements in the content of a table that still grows: one row is enough.

    Raises InvalidFile as `read_measurements` does, and where a row has no position.
    """
    _check_names(arm)
    read = _read(table_of(content, path, description.columns), arm)
    if read.coordinates is None:
        raise InvalidFile(path, _lacking(arm, arm.joints[0]))
    if read.positions is None:
        raise InvalidFile(path, "no positions are measured in it; expected: x, y and z")
    return read


def _check_copies(table: Table) -> None:
    """Raise InvalidFile where many rows are copies: they would count as measured anew."""
    first: dict[tuple[str, ...], int] = {}
    rows = enumerate(zip(*table.cells.values(), strict=True), 1)
    copies = [(row, its) for row, cells in rows if (its := first.setdefault(cells, row)) != row]
    if len(copies) > COPIES * len(table):
        row, other = copies[0]
        raise InvalidFile(
            table.path,
            f"{len(copies)} of its {len(table)} rows are copies of others, such as row {row} of row"
            f" {other}; expected: rows that were measured one by one",
        )


def _check_names(arm: Arm) -> None:
    """Raise UnsuitableRobot where a joint's column would be that of a measurement, too."""
    for joint in arm.joints:
        if joint in MEASURED:
            raise UnsuitableRobot(
                f"the joint {joint!r} has the name of a measured column; try: another name for it"
                " in the URDF"
            )


def _read(table: Table, arm: Arm) -> Measurements:
    path = table.path
    table.check_columns([*arm.joints, *MEASURED, *SENT], _moved_by(arm))
    vectors = {group: _vector(table, group, kind) for group, kind in VECTORS.items()}
    coordinates = None
    if any(joint in table for joint in arm.joints):
        for joint in arm.joints:
            if joint not in table:
                raise InvalidFile(path, _lacking(arm, joint))
        coordinates = np.stack(
            [
                table.numbers(joint, kind)
                for joint, kind in zip(arm.joints, _kinds(arm), strict=True)
            ],
            axis=1,
        )
    targets, sockets = (_labels(table, label) for label in LABELS)
    return Measurements(
        len(table),
        coordinates,
        _positions(table, vectors),
        _rotations(table, vectors),
        vectors[NOMINAL],
        targets,
        sockets,
        _times(table),
    )


def _times(table: Table) -> np.ndarray | None:
    """Seconds (n,) from whenever."""
    if TIMES not in table:
        return None
    times = table.dates(TIMES) if not table.units[TIMES] else table.numbers(TIMES, TIME)
    if (early := np.diff(times) < 0).any():
        row = int(early.argmax()) + 2
        raise InvalidFile(
            table.path, f"row {row} was measured before row {row - 1}; try: sort the rows by time"
        )
    if times[0] == times[-1]:
        raise InvalidFile(table.path, f"column {TIMES!r} is the same in all rows; try: without it")
    return times


def _labels(table: Table, column: str) -> np.ndarray | None:
    if column not in table:
        return None
    labels = table.cells[column]
    if "" in labels:
        row = labels.index("") + 1
        raise InvalidFile(table.path, f"row {row} of column {column!r} is empty; expected: a name")
    first: dict[str, str] = {}
    for label in labels:
        if label != (other := first.setdefault(label.casefold(), label)):
            raise InvalidFile(
                table.path,
                f"{other!r} and {label!r} of column {column!r} differ in capitals alone; expected:"
                " one spelling",
            )
    return np.array(labels)


def _kinds(arm: Arm) -> list[Quantity]:
    return [LENGTH if slides else ANGLE for slides in arm.slides]


def _columns(arm: Arm) -> str:
    units = {ANGLE: "deg", LENGTH: "mm"}
    pairs = zip(arm.joints, _kinds(arm), strict=True)
    return listed((f"{joint} [{units[kind]}]" for joint, kind in pairs), "and")


def _moved_by(arm: Arm) -> str:
    """Why other joints have no columns, as where the tool is an inner link."""
    return f" ({arm.tool} is moved by {listed(arm.joints, 'and')})"


def _lacking(arm: Arm, joint: str) -> str:
    return f"the column of joint {joint!r} is missing; {arm.tool} is moved by {_columns(arm)}"


def _positions(table: Table, vectors: Vectors) -> np.ndarray | None:
    nominal, error, positions = vectors[NOMINAL], vectors[MISSED], vectors[POSITION]
    if error is None:
        return positions
    if nominal is None or positions is not None:
        raise InvalidFile(
            table.path, f"{listed(MISSED, 'and')} need {listed(NOMINAL, 'and')}, and no x, y, z"
        )
    return nominal + error


def _vector(table: Table, group: tuple[str, ...], kind: Quantity) -> np.ndarray | None:
    missing = [name for name in group if name not in table]
    if len(missing) == len(group):
        return None
    if missing:
        absent, whole = listed(missing, "and"), listed(group, "and")
        are = "is" if len(missing) == 1 else "are"
        raise InvalidFile(table.path, f"{absent} {are} missing: {whole} are needed together")
    return np.stack([table.numbers(name, kind) for name in group], axis=1)


def _rotations(table: Table, vectors: Vectors) -> np.ndarray | None:
    given = {group: its for group in ROTATIONS if (its := vectors[group]) is not None}
    if not given:
        return None
    if len(given) > 1:
        both = " and ".join(", ".join(group) for group in given)
        raise InvalidFile(table.path, f"its rotations are given twice: {both}; expected: once")
    if vectors[POSITION] is None and vectors[MISSED] is None:
        raise InvalidFile(table.path, "it has rotations without positions; expected: x, y, z, too")
    ((group, numbers),) = given.items()
    if group == QUATERNION:
        lengths = np.linalg.norm(numbers, axis=1)
        wrong = np.abs(lengths - 1) > SKEW
        if wrong.any():
            row = wrong.argmax()
            raise InvalidFile(
                table.path,
                f"the quaternion in row {row + 1} has length {lengths[row]:.3g}; expected: 1",
            )
        return Rotation.from_quat(numbers).as_matrix()
    if group[0] == "rx":
        return Rotation.from_rotvec(numbers).as_matrix()
    return Rotation.from_euler("xyz", numbers).as_matrix()
