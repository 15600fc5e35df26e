"""Tables of measurements and postures of an arm; see docs/own_arm.md."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH
from recalib.identification.checks.diagnostics import FEWEST
from recalib.laboratory.tables.columns import (
    DESIRED,
    ERRORS,
    FAKE_POSITIONS,
    FAKE_ROTATIONS,
    MEASURED,
    NOMINAL,
    POSITIONS,
    QUATERNIONS,
    ROTATION_VECTORS,
    SOCKETS,
    TARGETS,
    TIMES,
    Columns,
)
from recalib.laboratory.tables.conventions import TURNS
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.table import Table, named, read_table, table_of, table_text
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted, listed

PREFIX = "joint "  # before the name of a joint that is also the heading of a measured column
SKEW = 0.01  # error of a quaternion's length, from rounding by the instrument
COPIES = 0.1  # of the rows, at most: no instrument repeats itself so often to the last digit
MOVED = 0.05  # rad, m: if two joints move by more, the target moves, too
STILL = 1e-3  # rad, m: a joint that moves less might as well be held by its brake


@dataclass(frozen=True)
class Measurements:
    """Rows of a table, in SI units. See `Coupling` for joints that follow others."""

    path: Path  # of the table, for messages
    # (n, columns) rad, or m for sliding joints, as the controller reported them; None if not given
    joints: np.ndarray | None
    # poses (n, 4, 4) or positions (n, 3) [m] of targets in the instrument's frame; None if neither
    measured: np.ndarray | None
    columns: Mapping[str, np.ndarray]  # all other columns, by their names in `tables.columns`

    def __len__(self) -> int:
        rows = self.measured if self.joints is None else self.joints
        return 0 if rows is None else len(rows)

    @property
    def positions(self) -> np.ndarray | None:
        """Positions (n, 3) [m] of targets in the instrument's frame; None without any."""
        poses = self.measured
        return poses if poses is None or poses.ndim == 2 else poses[:, :3, 3]


def read_measurements(
    path: AnyPath, arm: Arm, description: Description | None = None
) -> Measurements:
    """The measurements of an arm in the table at `path`.

    Raises InvalidFile: not a table; a column that is missing, unknown, in a wrong unit, repeated
    or useless; a cell that is not a number or too large for an arm; too few rows; no measured
    columns; copied rows.
    """
    table = read_table(path, description.columns if description else None)
    rows = _read(table, arm, MEASURED)
    check_measured(rows)
    check_copies(table)
    return rows


def read_joints(path: AnyPath, arm: Arm) -> Measurements:
    """Joint coordinates and pictures in the table at `path`. Raises like `read_measurements`."""
    rows = _read(read_table(path), arm, MEASURED)
    _check_rows(rows)
    return rows


def read_desired(path: AnyPath, arm: Arm, target: bool = False) -> Measurements:
    """Desired joint coordinates, or poses or positions, or both, in the table at `path`.

    Args:
        target: whether rows may name the target whose pose is desired.

    Raises InvalidFile like `read_measurements`, but one row is enough; also for columns that only
    measurements have, and for commands, which are corrected already.
    """
    table = read_table(path)
    if TARGETS.headings[0] in table and not target:
        raise InvalidFile(path, "column 'target' needs recalib correct --frame instrument")
    if FAKE_POSITIONS.headings[0] in table:
        raise InvalidFile(path, "its commands are corrected already; expected: desired poses")
    rows = _read(table, arm, DESIRED, joints_needed=False)
    if rows.joints is None and rows.measured is None:
        valid = listed(joint_headings(arm), "and")
        raise InvalidFile(path, f"it has neither x, y, z nor joints; expected: {valid}")
    return rows


def measurements_so_far(
    content: bytes, path: AnyPath, arm: Arm, description: Description
) -> Measurements:
    """The measurements in the content of a growing table: one row is enough.

    Raises InvalidFile like `read_measurements`, and if the table has no positions.
    """
    rows = _read(table_of(content, path, description.columns), arm, MEASURED)
    if rows.measured is None:
        raise InvalidFile(path, "it has no measured positions; expected: x, y and z")
    _check_stuck(rows)
    return rows


def joint_headings(arm: Arm, angle: str = "deg", length: str = "mm") -> list[str]:
    """The headings of an arm's joints, with units, in tables that we write."""
    taken = {heading for kind in MEASURED for heading in kind.headings}
    joints = map(named, arm.coupling.columns)
    names = (PREFIX + joint if joint in taken else joint for joint in joints)
    units = (length if slides else angle for slides in arm.coupling.slides)
    return [f"{name} [{unit}]" for name, unit in zip(names, units, strict=True)]


def postures_table(arm: Arm, joints: np.ndarray, poses: np.ndarray, fake: bool = False) -> bytes:
    """The CSV text of joint coordinates (n, columns) and poses (n, 4, 4), which we can read.

    Fake poses are commands. `read_desired` refuses their columns: they are corrected already.
    """
    scales = [1e3 if slides else 180 / np.pi for slides in arm.coupling.slides]
    texts = [[f"{number:.9f}" for number in row] for row in joints * scales]
    cells = (dict(zip(joint_headings(arm), row, strict=True)) for row in texts)
    return table_text(row | pose for row, pose in zip(cells, pose_rows(poses, fake), strict=True))


def pose_rows(poses: np.ndarray, fake: bool = False) -> Iterator[dict[str, str]]:
    """For each pose (n, 4, 4) [m], its cells by heading; see `postures_table`."""
    kinds = (FAKE_POSITIONS, FAKE_ROTATIONS) if fake else (POSITIONS, ROTATION_VECTORS)
    headings = [heading for kind in kinds for heading in kind.written]
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_rotvec(degrees=True)
    for row in np.concatenate([1e3 * poses[:, :3, 3], turns], axis=1):
        yield dict(zip(headings, (f"{number:.9f}" for number in row), strict=True))


def check_measured(rows: Measurements) -> None:
    """Raise InvalidFile unless an arm can be calibrated from the rows."""
    sockets = SOCKETS.name in rows.columns
    if rows.measured is None and not sockets:
        raise InvalidFile(rows.path, "it has no measured columns; expected: x, y, z or socket")
    if rows.measured is not None and sockets:
        raise InvalidFile(rows.path, "it has both positions and sockets; expected: one of them")
    _check_rows(rows)
    _check_stuck(rows)


def _check_rows(rows: Measurements) -> None:
    assert rows.joints is not None
    if (times := rows.columns.get(TIMES.name)) is not None:
        if (early := np.diff(times) < 0).any():
            row = int(early.argmax()) + 2
            found = f"row {row} was measured before row {row - 1}; try: sort the rows by time"
            raise InvalidFile(rows.path, found)
        if len(times) > 1 and times[0] == times[-1]:
            raise InvalidFile(rows.path, "column 'time' is the same in all rows; try: omit it")
    if len(rows) < FEWEST:
        found = f"it has {counted(len(rows), 'row')}; expected: at least {FEWEST}"
        raise InvalidFile(rows.path, found)
    if (np.ptp(rows.joints, axis=0) < STILL).all():
        raise InvalidFile(rows.path, "no joint moves; expected: rows of different postures")


def _check_stuck(rows: Measurements) -> None:
    """Raise InvalidFile if measurements stay the same to the last digit while the arm moves."""
    if rows.measured is None or rows.joints is None:
        return
    moved = (np.abs(np.diff(rows.joints, axis=0)) > MOVED).sum(axis=1) > 1
    equal = (np.diff(rows.measured.reshape(len(rows), -1), axis=0) == 0).all(axis=1)
    if len(stuck := np.flatnonzero(moved & equal)) > 1:
        found = f"{len(stuck)} of its rows, such as {stuck[0] + 2}, repeat the previous measurement"
        raise InvalidFile(
            rows.path, f"{found}, in another posture; expected: the target in sight; try: omit them"
        )


def check_copies(table: Table) -> None:
    """Raise InvalidFile if many rows are copies, which would count as new measurements."""
    first: dict[tuple[str, ...], int] = {}
    rows = enumerate(zip(*table.cells.values(), strict=True), 1)
    copies = [(row, other) for row, key in rows if (other := first.setdefault(key, row)) != row]
    if len(copies) > COPIES * len(table):
        row, other = copies[0]
        raise InvalidFile(
            table.path,
            f"{len(copies)} of its {len(table)} rows are copies of others, such as row {row} of row"
            f" {other}; expected: independent measurements",
        )


def _read(
    table: Table, arm: Arm, layout: Sequence[Columns], joints_needed: bool = True
) -> Measurements:
    columns = [named(joint) for joint in arm.coupling.columns]
    for joint in map(named, arm.joints):
        if joint in table and joint not in columns:
            raise InvalidFile(
                table.path,
                f"column {joint!r} is that of a joint that follows another by <mimic>; expected:"
                f" {listed(columns, 'and')}; try: without it, or a URDF without <mimic>",
            )
    names = [PREFIX + joint if PREFIX + joint in table else joint for joint in columns]
    others = [kind for kind in layout if not {*names} & {*kind.headings}]
    for kind in (kind for kind in layout if kind not in others):
        if rest := [name for name in kind.headings if name in table and name not in names]:
            name = next(name for name in kind.headings if name in names)
            raise InvalidFile(
                table.path,
                f"column {name!r} is the joint's, but {listed(rest, 'and')} need a measured"
                f" {name}; try: call the joint's column '{PREFIX}{name}'",
            )
    note = f" ({arm.tool} is moved by {listed(columns, 'and')})"
    arrays, joints = table.read(others, names, note), None
    missing = [name for name in names if name not in table]
    if missing and (joints_needed or len(missing) < len(names)):
        reason = f"the column of joint {missing[0]!r} is missing; {arm.tool} is moved by"
        raise InvalidFile(table.path, f"{reason} {listed(joint_headings(arm), 'and')}")
    if not missing:
        kinds = (LENGTH if slides else ANGLE for slides in arm.coupling.slides)
        pairs = zip(names, kinds, strict=True)
        joints = np.stack([table.numbers(name, kind) for name, kind in pairs], axis=1)
    return Measurements(table.path, joints, _measured(table.path, arrays), arrays)


def _measured(path: Path, given: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Poses (n, 4, 4) or positions (n, 3) [m] from columns; None if there are neither.

    Raises InvalidFile if columns contradict each other, or are useless.
    """
    turns = [kind for kind in TURNS if kind.name in given]
    positions = given.get(POSITIONS.name)
    if ERRORS.name in given:
        if NOMINAL.name not in given or positions is not None:
            names = f"{listed(ERRORS.headings, 'and')} need {listed(NOMINAL.headings, 'and')}"
            raise InvalidFile(path, f"{names}, and no x, y, z")
        positions = given[NOMINAL.name] + given[ERRORS.name]
    if len(turns) > 1:
        both = " and ".join(", ".join(kind.headings) for kind in turns)
        raise InvalidFile(path, f"its rotations are given twice: {both}; expected: once")
    if not turns:
        return positions
    if positions is None:
        raise InvalidFile(path, "it has rotations without positions; expected: also x, y, z")
    (kind,) = turns
    with np.errstate(over="ignore"):  # an infinite length is refused below
        lengths = np.linalg.norm(given[kind.name], axis=1)
    if kind is QUATERNIONS and (wrong := np.abs(lengths - 1) > SKEW).any():
        row = int(wrong.argmax())
        found = f"the quaternion in row {row + 1} has length {lengths[row]:.3g}; expected: 1"
        raise InvalidFile(path, found)
    poses = np.tile(np.eye(4), (len(positions), 1, 1))
    poses[:, :3, :3] = TURNS[kind](given[kind.name]).as_matrix()
    poses[:, :3, 3] = positions
    return poses
