"""Tables of poses that a controller or a camera wrote: with headings, or numbers alone."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import chain
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.storage import read_file
from recalib.identification.model.frames import nearest_rotation
from recalib.laboratory.hand_eye.conventions import (
    CONVENTIONS,
    MATRIX,
    OWN,
    Convention,
    convention_of,
)
from recalib.laboratory.tables.columns import PICTURES, POSITIONS
from recalib.laboratory.tables.table import MOST, Table, table_of
from recalib.spelling import listed

SKEW = 0.02  # of a quaternion's length, or a matrix' products of columns, as people round them
MATRICES = 12, 16  # numbers of a pose, without and with its last row
OF_MATRIX = (
    *MATRIX[:3],
    "x",
    *MATRIX[3:6],
    "y",
    *MATRIX[6:],
    "z",
    *(f"last {n}" for n in range(4)),
)
_BETWEEN = re.compile(r"[\s,;]+")
_COMMENT = re.compile(r"^\s*(#|%|//).*$", re.MULTILINE)
_LETTERS = re.compile(r"[a-df-zA-DF-Z]")  # e is in 1e-3


@dataclass(frozen=True)
class PoseTable:
    """Poses, row by row.

    Attributes:
        path: of the file, for messages.
        pictures: the file of each row's picture; None if the table has no such column.
        positions, rotations: (n, 3) m and (n, 3, 3).
        turns: (n, k) rad or 1, the numbers of the rotations.
        inverted: whether poses are wanted in the other direction.
    """

    path: Path
    pictures: list[str] | None
    positions: np.ndarray
    rotations: np.ndarray
    turns: np.ndarray
    inverted: bool = False

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, rows: np.ndarray) -> "PoseTable":
        arrays = {name: getattr(self, name)[rows] for name in ("positions", "rotations", "turns")}
        names = None if self.pictures is None else [self.pictures[row] for row in rows]
        return replace(self, pictures=names, **arrays)

    @property
    def poses(self) -> np.ndarray:
        """(n, 4, 4) m."""
        poses = np.tile(np.eye(4), (len(self), 1, 1))
        poses[:, :3, :3], poses[:, :3, 3] = self.rotations, self.positions
        return np.linalg.inv(poses) if self.inverted else poses


def read_poses(
    path: str | PathLike[str], convention: str | None = None, unit: str | None = None
) -> PoseTable:
    """The poses in the table at `path`.

    Args:
        convention: how its rotations are written; by its headings if it is None.
        unit: of positions, if neither headings nor the convention have the right one.

    Raises InvalidFile: columns that are missing, a cell that is no number, a rotation that is none;
    UnknownName: the convention.
    """
    way = None if convention is None else convention_of(convention)
    content = read_file(path, MOST)
    numbers = _COMMENT.sub("", content.decode("utf-8-sig", "replace"))
    if _LETTERS.search(numbers):
        table = table_of(content, path)
        headings = [name.lower() for name in table.cells]
        table = Table(
            table.path,
            dict(zip(headings, table.units.values(), strict=True)),
            dict(zip(headings, table.cells.values(), strict=True)),
            dict(zip(headings, table.headings.values(), strict=True)),
        )
        way = way or _by_headings(table)
    else:
        table, way = _of_numbers(numbers, Path(path), way)
    layout = way.layout
    units = dict(table.units)
    for columns, own in zip(layout, (unit or way.length, way.angle), strict=True):
        units |= {name: units.get(name) or own for name in columns.headings}
    table = replace(table, units=units)
    arrays = table.read((*layout, PICTURES), [*table.cells])
    names = arrays.get(PICTURES.name)
    pictures = None if names is None else [str(name) for name in names]
    rotations = _rotations(table.path, way, arrays["turns"])
    return PoseTable(table.path, pictures, arrays["positions"], rotations, arrays["turns"])


def _by_headings(table: Table) -> Convention:
    """What the headings say. Raises InvalidFile if they are those of no rotation."""
    for way in OWN:
        if all(heading in table for heading in way.headings):
            return way
    valid = listed((", ".join(way.headings) for way in OWN), "or")
    raise InvalidFile(
        table.path, f"it has no rotation; expected: {valid}; or try: --convention, such as kuka"
    )


def _of_numbers(text: str, path: Path, way: Convention | None) -> tuple[Table, Convention]:
    """A table of numbers without headings: a pose a row, or matrices of four rows each."""
    lines = (line.strip(" \t,;[]()") for line in text.splitlines())
    rows = [_BETWEEN.split(line) for line in lines if line]
    if not rows:
        raise InvalidFile(path, "it is empty")
    if len(rows) > 1 and len(rows[0]) == 1:  # how many poses follow
        rows = rows[1:]
    counts = {len(row) for row in rows}
    if counts == {4} and len(rows) % 4 == 0:
        rows = [[*chain(*rows[first : first + 4])] for first in range(0, len(rows), 4)]
    if len(counts) != 1:
        raise InvalidFile(path, "its rows have different lengths; expected: a pose in each row")
    if (count := len(rows[0])) in MATRICES:
        way, headings = CONVENTIONS["matrix"], [*OF_MATRIX[:count]]
    elif way is None:
        raise InvalidFile(path, "it has no headings; try: --convention, such as ur or kuka")
    else:
        headings = [*POSITIONS.headings, *way.headings]
        if count == len(headings) + 1:
            headings = ["time", *headings]
    if count != len(headings):
        valid = f"{len(headings)}, {', '.join(headings)}"
        raise InvalidFile(path, f"it has {count} numbers in a row; expected: {valid}")
    cells = {name: [row[at] for row in rows] for at, name in enumerate(headings)}
    units: Mapping[str, str] = dict.fromkeys(headings, "")
    return Table(path, units, cells, {name: name for name in headings}), way


def _rotations(path: Path, way: Convention, numbers: np.ndarray) -> np.ndarray:
    """Rotations (n, 3, 3). Raises InvalidFile if numbers are far from those of a rotation."""
    if numbers.shape[1] == 4:
        off = np.abs(np.linalg.norm(numbers, axis=1) - 1)
        kind = "the quaternion in row {} has length {:.3g}; expected: 1"
        shown = np.linalg.norm(numbers, axis=1)
    elif numbers.shape[1] == 9:
        matrices = numbers.reshape(-1, 3, 3)
        off = np.abs(matrices @ matrices.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
        shown = np.linalg.det(matrices)
        off = np.where(shown > 0, off, 1.0)
        kind = "the matrix in row {} is no rotation: its determinant is {:.3g}; expected: 1"
        numbers = np.array([nearest_rotation(matrix) for matrix in matrices]).reshape(-1, 9)
    else:
        return way.turns(numbers).as_matrix()
    if (off > SKEW).any():
        row = int((off > SKEW).argmax())
        raise InvalidFile(path, kind.format(row + 1, shown[row]))
    return way.turns(numbers).as_matrix()
