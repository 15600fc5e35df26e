"""A table (CSV) whose header names each column and its unit: `elbow_joint [deg]`, `x [mm]`."""

import csv
import io
import math
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import ANGLE, LENGTH, TIME, Quantity
from recalib.files.storage import read_file
from recalib.spelling import counted, instead, listed

_HEADING = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[\s*(?P<unit>[^\[\]]*?)\s*\])?\s*")
NUMBER = Quantity("a number", {"": 1.0})
IGNORED = "ignored"
POSE = "x [mm]", "y [mm]", "z [mm]", "rx [deg]", "ry [deg]", "rz [deg]"  # as we write poses
FAKE = tuple(heading.replace(" ", "_fake ") for heading in POSE)  # as we write poses to send
FARTHEST = {  # that an arm could reach, and that a clock could show
    ANGLE: (4 * np.pi, "720 deg"),
    LENGTH: (10.0, "10 m"),
    TIME: (1e10, "1e10 s"),
}
SEPARATORS = {";": "semicolons", "\t": "tabs"}  # that others write in place of commas
MOST, MOST_ROWS = 32_000_000, 10_000  # bytes; rows, which a computer calibrates by in an hour


@dataclass(frozen=True)
class Table:
    """The cells of a table, by column. Rows are counted from 1, without the header.

    Attributes:
        path: of the file, for messages.
        units: of each column, empty where the header has none.
        cells: of each column, as many as there are rows.
        headings: what the file calls each column, if a description calls it otherwise.
    """

    path: Path
    units: Mapping[str, str]
    cells: Mapping[str, list[str]]
    headings: Mapping[str, str]

    def __len__(self) -> int:
        return len(next(iter(self.cells.values())))

    def __contains__(self, column: str) -> bool:
        return column in self.cells

    def numbers(self, column: str, quantity: Quantity) -> np.ndarray:
        """The numbers (n,) in a column, in SI units.

        Raises InvalidFile: another unit, or a cell that is no number or too large for an arm.
        """
        unit = self.units[column]
        if unit not in quantity.units:
            given = f"is in {unit!r}" if unit else "names no unit"
            units = sorted(quantity.units)
            valid = listed((f"{column} [{unit}]" if unit else column for unit in units), "or")
            raise InvalidFile(self.path, f"column {column!r} {given}; expected: {valid}")
        numbers = np.array([_number(cell) for cell in self.cells[column]])
        self._check(column, np.isfinite(numbers), "expected: a number")
        numbers *= quantity.units[unit]
        most, text = FARTHEST.get(quantity, (np.inf, ""))
        valid = f"expected: up to {text}. Is its unit right?"
        self._check(column, np.abs(numbers) <= most, valid, unit)
        return numbers

    def dates(self, column: str) -> np.ndarray:
        """The moments (n,) in a column, in seconds.

        Raises InvalidFile: a cell that is none.
        """
        dates = np.array([_date(cell) for cell in self.cells[column]])
        valid = f"expected: a date as 2026-11-23T08:15:00.5, or seconds in {column} [s]"
        self._check(column, np.isfinite(dates), valid)
        return dates

    def _check(self, column: str, good: np.ndarray, valid: str, unit: str | None = None) -> None:
        """Raise InvalidFile, which shows the first cell that is not good (n,)."""
        if not good.all():
            row = int(good.argmin())
            cell = self.cells[column][row]
            found = repr(cell) if unit is None else f"{cell} {unit}"
            place = f"row {row + 1} of column {self.headings[column]!r}"
            raise InvalidFile(self.path, f"{place} is {found}; {valid}")

    def check_columns(self, valid: Collection[str], note: str = "") -> None:
        """Raise InvalidFile of a column that is not valid; a note says of angles why."""
        for column in self.cells:
            if column not in valid:
                bracketed = "expected: its unit in square brackets, as in 'x [mm]'"
                why = note if self.units[column] in ANGLE.units else ""  # others are no joints
                right = bracketed if column.endswith(")") else instead(column, valid)
                raise InvalidFile(self.path, f"unknown column {column!r}{why}; {right}")


def read_table(
    path: str | PathLike[str], columns: Mapping[str, str] | None = None, most: int = MOST_ROWS
) -> Table:
    """The table at `path`; see `table_of`. Raises InvalidFile."""
    return table_of(read_file(path, MOST), path, columns, most)


def table_of(
    content: bytes,
    path: str | PathLike[str],
    columns: Mapping[str, str] | None = None,
    most: int = MOST_ROWS,
) -> Table:
    """The table in a file's content: UTF-8, commas between cells, a header, rows below it.

    Args:
        path: of the file, for messages.
        columns: by a heading of the file what should have stood there, or "ignored".
        most: rows.

    Raises InvalidFile: not such a table, or a heading in `columns` that is not there.
    """
    path, columns = Path(path), columns or {}
    try:
        lines = csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""))
        filled = (row for row in lines if any(cell.strip() for cell in row))
        rows = list(islice(filled, most + 2))
    except (UnicodeDecodeError, csv.Error):
        raise InvalidFile(path, "it is no CSV in UTF-8") from None
    if len(rows) > most + 1:
        raise InvalidFile(path, f"it has more than {most} rows; try: every tenth of them")
    if len(rows) < 2:
        raise InvalidFile(path, "it is empty" if not rows else "it has a header and no row")
    headings = [cell.strip() for cell in rows[0]]
    for separator, name in SEPARATORS.items():
        if len(headings) == 1 and separator in headings[0]:
            raise InvalidFile(path, f"its columns are separated by {name}; expected: commas")
    if unknown := [heading for heading in columns if heading not in headings]:
        raise InvalidFile(
            path, f"its description names column {unknown[0]!r}; it has {', '.join(headings)}"
        )
    for row, line in enumerate(rows[1:], 1):
        if len(line) != len(headings):
            raise InvalidFile(
                path,
                f"row {row} has {counted(len(line), 'cell')}; expected: {len(headings)}, as in the"
                " header",
            )
    units: dict[str, str] = {}
    cells: dict[str, list[str]] = {}
    shown: dict[str, str] = {}
    for index, heading in enumerate(headings):
        meant = columns.get(heading, heading)
        if meant == IGNORED:
            continue
        if not meant and not heading:
            raise InvalidFile(path, f"column {index + 1} has no heading")
        parts = _HEADING.fullmatch(meant)
        if not parts or not parts["name"]:
            raise InvalidFile(path, f"heading {meant!r} is no name with a unit, as 'x [mm]' is")
        name = parts["name"]
        if name in cells:
            raise InvalidFile(path, f"it has more than one column {name!r}")
        units[name], cells[name] = parts["unit"] or "", [row[index].strip() for row in rows[1:]]
        shown[name] = heading if heading in columns else name
    if not cells:
        raise InvalidFile(path, "its description ignores every column")
    return Table(path, units, cells, shown)


def write_table(path: Path, rows: Iterable[Mapping[str, object]]) -> None:
    """Write rows, of which there is at least one: cells by heading, in the same order in each."""
    rows = list(rows)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, fieldnames=rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _date(cell: str) -> float:
    try:
        date = datetime.fromisoformat(cell)
    except ValueError:
        return math.nan
    return (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()


def _number(cell: str) -> float:
    """The number in a cell, or that there is none. Python alone reads 1_0, as ten."""
    try:
        return math.nan if "_" in cell else float(cell)
    except ValueError:
        return math.nan
