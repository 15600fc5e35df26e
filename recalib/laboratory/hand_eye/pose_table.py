"""Tables of poses from a controller or a camera."""

import re
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH, NUMBER
from recalib.laboratory.hand_eye.pose_files import read_text
from recalib.laboratory.tables.columns import PICTURE, PICTURES, POSITIONS, Columns
from recalib.laboratory.tables.conventions import (
    CONVENTIONS,
    MATRIX,
    OWN,
    POSE,
    Convention,
    convention_of,
)
from recalib.laboratory.tables.records import BETWEEN, BRACKETS, NAMED, poses_in
from recalib.laboratory.tables.table import Table, number_in, table_of
from recalib.spelling import listed

NORMS = {4: 1.0, 9: 3**0.5}  # of quaternions and of rotation matrices, by their count of numbers
SKEW = 0.02  # relative error of a norm, from rounding
_LABEL = re.compile(r"^\s*[A-Za-z_][^\n\[\]{},;:=]*:?[:=]|\w*array(?=\()", re.MULTILINE)
_LIST = re.compile(r"\[\s*[-.\d\[]")
_LETTERS = re.compile(r"[a-df-zA-DF-Z]")  # without e, which is in 1e-3
_NAN = re.compile(r"\b(nan|inf|infinity)\b", re.IGNORECASE)
FEWEST = 6  # headings of a pose: fewer words are a remark
_ALONE = "by such headings, or by numbers alone in this order, without headings"


@dataclass(frozen=True)
class PoseTable:
    """Poses, row by row."""

    table: Table
    positions: np.ndarray  # (n, 3) m
    rotations: Rotation
    turns: np.ndarray  # (n, k) rad or 1, the rotations as the table writes them
    inverted: bool = False  # whether the table has the inverse of the poses

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, rows: np.ndarray) -> "PoseTable":
        arrays = {name: getattr(self, name)[rows] for name in ("positions", "rotations", "turns")}
        return replace(self, **arrays)

    @property
    def poses(self) -> np.ndarray:
        """The poses (n, 4, 4) [m], inverted back if the table has the inverse."""
        poses = RigidTransform.from_components(self.positions, self.rotations).as_matrix()
        return np.linalg.inv(poses) if self.inverted else poses


def read_poses(
    path: AnyPath,
    convention: str | None = None,
    unit: str | None = None,
    inverted: bool = False,
    targets: bool = False,
) -> PoseTable:
    """The poses in the table at `path`, or in files of other programs.

    Args:
        convention: the notation of rotations; if None, the headings decide.
        unit: of positions without a unit in their heading; default: that of the convention.
        inverted: whether the table has the inverse poses.
        targets: whether the target's poses are read, if a file has both.

    Raises InvalidFile: a missing column, a cell that is not a number, numbers that are not a
    rotation; UnknownName: an unknown convention.
    """
    way = None if convention is None else convention_of(convention)
    headings = way.headings if way else ()
    text, rows = read_text(path, targets, headings)
    if ";" in (head := text.partition("\n")[0]) and not _LIST.search(head):  # commas are decimal
        text = text.replace(",", ".").replace(";", ",")
    lines = [*filter(_cells, _LABEL.sub("", text).splitlines())]
    lines = [line for line in lines if _is_row(line) or len(_cells(line)) >= FEWEST] or lines
    if not (rows or lines):
        raise InvalidFile(path, "it is empty")
    if rows or _is_row(lines[0]):
        text = _headed(rows or [*map(_cells, lines)], Path(path), way)
    else:
        text = _separated(lines)
    table = table_of(text.encode(), path)
    lengths = {unit for unit in table.units.values() if unit in LENGTH.units}
    if "x" not in table and len(lengths) < 2 and "deg" not in table.units.values():
        cells = zip(*table.cells.values(), strict=True)
        records = [dict(zip(table.cells, row, strict=True)) for row in cells]
        if rows := [*poses_in(records, targets, headings)]:
            table = table_of(_headed(rows, Path(path), way).encode(), path)
            unit = unit or next(iter(lengths), None)
    if way is None or MATRIX[0] in table:
        way = next((own for own in OWN if all(name in table for name in own.headings)), None)
    if way is None:
        ways = listed((", ".join(own.headings) for own in OWN if own.headings != MATRIX), "or")
        found = f"it has no rotation; expected: {ways}"
        raise InvalidFile(path, f"{found}; or try: --convention, such as kuka")
    kind = ANGLE if len(way.headings) == 3 else NUMBER
    layout = (
        Columns("positions", POSITIONS.headings, LENGTH, _ALONE, needed=True),
        Columns("turns", way.headings, kind, _ALONE, needed=True),
    )
    units = dict(table.units)
    for columns, own in zip(layout, (unit or way.length, way.angle), strict=True):
        units |= {name: units.get(name) or own for name in columns.headings}
    places = [abs(number_in(cell)) for cell in table.cells.get("x", ())]
    if unit is None and units["x"] == "m" and np.max(places, initial=0) > LENGTH.farthest:
        raise InvalidFile(
            path,
            f"x in row 1 is {table.cells['x'][0]} m. Is its unit right? Try:"
            f" --{'target-' * targets}unit mm",
        )
    table = replace(table, units=units)
    arrays = table.read((*layout, PICTURES), [*table.cells])
    turns, valid = arrays["turns"], NORMS.get(len(way.headings))
    if valid and (off := ~(np.abs(np.linalg.norm(turns, axis=1) / valid - 1) <= SKEW)).any():
        found = f"has the norm {np.linalg.norm(turns, axis=1)[off][0]:.3g}"
        raise InvalidFile(
            path, f"the rotation in row {off.argmax() + 1} {found}; expected: {valid:.3g}"
        )
    try:
        rotations = way.turns(turns)
    except ValueError:  # of SciPy, in several lines
        row = int((np.linalg.det(turns.reshape(-1, 3, 3)) <= 0).argmax()) + 1
        found = f"the matrix in row {row} is mirrored; expected: a rotation"
        raise InvalidFile(path, found) from None
    return PoseTable(table, arrays["positions"], rotations, turns, inverted)


def _cells(line: str) -> list[str]:
    return [cell for cell in BETWEEN.split(BRACKETS.sub(" ", line)) if cell]


def _is_row(line: str) -> bool:
    """Whether a line has numbers, and is no heading."""
    numbers = any(np.isfinite(number_in(cell)) for cell in _cells(line))
    return numbers or not _LETTERS.search(_NAN.sub("", line))


def _separated(lines: list[str]) -> str:
    """The text of a table with headings in small letters, and commas between cells."""
    head = re.sub(r"\((mm|cm|m|deg|rad)\)", r"[\1]", re.sub("^(?=,)", "row", lines[0].lower()))
    between = r"(?!)" if "," in head else "\t" if "\t" in head else r"[ \t]+"
    return re.sub(rf"(?<=\S){between}(?=\S)", ",", "\n".join([head, *lines[1:]]))


def _headed(rows: list[list[str]], path: Path, way: Convention | None) -> str:
    """Add headings to numbers alone: a pose in each row, or a matrix in each three or four."""
    least = (
        4 if max(map(len, rows)) == 4 else 2
    )  # fewer whole numbers count the poses, or number one
    rows = [row for row in rows if len(row) >= least or not all(map(str.isdigit, row))] or rows
    ahead: list[list[str]] = []  # columns of names and times
    words = [[cell for cell in row if _LETTERS.search(_NAN.sub("", cell))] for row in rows]
    if {*map(len, words)} == {1}:
        ahead = [[PICTURE if NAMED.search(words[0][0]) else "name", *chain(*words)]]
        rows = [
            [cell for cell in row if cell not in word]
            for row, word in zip(rows, words, strict=True)
        ]
    if {len(row) for row in rows} == {4}:
        lasts = *rows, [row[-1] for row in rows[:4]]  # the last column, if they are transposed
        high = 4 if any([*map(number_in, last)] == [0, 0, 0, 1] for last in lasts) else 3
        rows = [[*chain(*rows[first : first + high])] for first in range(0, len(rows), high)]
    if len({len(row) for row in rows}) > 1:
        raise InvalidFile(path, "its rows have different lengths; expected: a pose in each row")
    count, headings = len(rows[0]), [*POSE]
    if way is CONVENTIONS["abb"] and count == 17:  # a robtarget, with configuration and other axes
        rows, count = [row[:7] for row in rows], 7
    fields = [*POSITIONS.headings, *(way.headings if way else ())]
    begins = [number_in(row[0]) for row in rows]
    if count - 1 in (12, 16, len(fields)) and count != len(fields) and (np.diff(begins) >= 0).all():
        ahead, count = [*ahead, ["time", *(row[0] for row in rows)]], count - 1
        rows = [row[1:] for row in rows]
    ends = [row[12:] for row in rows if [*map(number_in, row[12:])] != [0, 0, 0, 1]]
    if count == 16 and ends:
        found = f"the last row of a matrix is {' '.join(ends[0])}; expected: 0 0 0 1"
        raise InvalidFile(path, f"{found}; is it transposed?")
    if count not in (12, 16):
        if way is None:
            valid = "try: --convention or --target-convention"
            raise InvalidFile(path, f"it has {count} numbers in a row, without headings; {valid}")
        headings = fields
        if count != len(headings):
            valid = f"{len(headings)}, {', '.join(headings)}"
            valid += "; does it have decimal commas?" * (count == 2 * len(headings))
            raise InvalidFile(path, f"it has {count} numbers in a row; expected: {valid}")
    columns = [*ahead, *map(list, zip(headings[:count], *rows, strict=True))]
    return "\n".join(map(",".join, zip(*columns, strict=True)))
