"""A table (CSV) whose header names each column and its unit: `elbow_joint [deg]`, `x [mm]`."""

import csv
import io
import math
import re
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from os import PathLike
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.quantities import ANGLE, LENGTH, Quantity
from recalib.spelling import instead
from recalib.storage import read_file

_HEADING = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[\s*(?P<unit>[^\[\]]*?)\s*\])?\s*")
NUMBER = Quantity("a number", {"": 1.0})
IGNORED = "ignored"
FARTHEST = {ANGLE: (4 * np.pi, "720 deg"), LENGTH: (10.0, "10 m")}  # that an arm could reach
MOST, MOST_ROWS = 32_000_000, 10_000  # bytes; rows, which a computer calibrates by in an hour


@dataclass(frozen=True)
class Table:
    """The cells of a table, by column. Rows are counted from 1, without the header.

    Attributes:
        path: of the file, for messages.
        units: of each column, empty where the header has none.
        cells: of each column, as many as there are rows.
        headings: of columns that a description calls otherwise, as the file has them.
    """

    path: Path
    units: Mapping[str, str]
    cells: Mapping[str, list[str]]
    headings: Mapping[str, str]

    def shown(self, column: str) -> str:
        """What the file calls a column."""
        return self.headings.get(column, column)

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
            valid = ", ".join(
                f"{column} [{each}]" if each else column for each in sorted(quantity.units)
            )
            raise InvalidFile(self.path, f"column {column!r} {given}; valid: {valid}")
        numbers = [_number(cell) for cell in self.cells[column]]
        for row, (number, cell) in enumerate(zip(numbers, self.cells[column], strict=True), 1):
            if not math.isfinite(number):
                raise InvalidFile(
                    self.path,
                    f"row {row} of column {self.shown(column)!r} is {cell!r}; valid: a number",
                )
        numbers = np.array(numbers) * quantity.units[unit]
        most, text = FARTHEST.get(quantity, (np.inf, ""))
        beyond = np.abs(numbers) > most
        if beyond.any():
            cell = self.cells[column][beyond.argmax()]
            raise InvalidFile(
                self.path,
                f"row {beyond.argmax() + 1} of column {self.shown(column)!r} is {cell} {unit};"
                f" valid: up to {text}. Is its unit right?",
            )
        return numbers

    def dates(self, column: str) -> np.ndarray:
        """The moments (n,) in a column, in seconds.

        Raises InvalidFile: a cell that is none.
        """
        dates = [_date(cell) for cell in self.cells[column]]
        if None in dates:
            row = dates.index(None)
            raise InvalidFile(
                self.path,
                f"row {row + 1} of column {self.shown(column)!r} is {self.cells[column][row]!r};"
                f" expected: a date as 2026-11-23T08:15:00.5, or seconds in {column} [s]",
            )
        return np.array(dates)

    def check_columns(self, valid: Collection[str]) -> None:
        """Raise InvalidFile where a column is not among the valid ones."""
        for column in self.cells:
            if column not in valid:
                raise InvalidFile(self.path, f"unknown column {column!r}; {instead(column, valid)}")


def read_table(path: str | PathLike, columns: Mapping[str, str] | None = None) -> Table:
    """The table at `path`: UTF-8, commas between cells, a header, a row for each measurement.

    Args:
        columns: by a heading of the file what should have stood there, or "ignored".

    Raises InvalidFile: not such a table, or a heading in `columns` that is not there.
    """
    path, columns = Path(path), columns or {}
    content = read_file(path, MOST)
    try:
        lines = csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""))
        filled = (row for row in lines if any(cell.strip() for cell in row))
        rows = list(islice(filled, MOST_ROWS + 2))
    except (UnicodeDecodeError, csv.Error):
        raise InvalidFile(path, "it is no CSV in UTF-8") from None
    if len(rows) > MOST_ROWS + 1:
        raise InvalidFile(path, f"it has more than {MOST_ROWS} rows; try: every tenth of them")
    if len(rows) < 2:
        raise InvalidFile(path, "it is empty" if not rows else "it has a header and no row")
    headings = [cell.strip() for cell in rows[0]]
    if len(headings) == 1 and ";" in headings[0]:
        raise InvalidFile(path, "its columns are separated by semicolons; valid: commas")
    if unknown := [heading for heading in columns if heading not in headings]:
        raise InvalidFile(
            path, f"its description names column {unknown[0]!r}; it has {', '.join(headings)}"
        )
    for row, cells in enumerate(rows[1:], 1):
        if len(cells) != len(headings):
            raise InvalidFile(
                path, f"row {row} has {len(cells)} cells; valid: {len(headings)}, as in the header"
            )
    meant = [columns.get(heading, heading) for heading in headings]
    kept = [index for index, heading in enumerate(meant) if heading != IGNORED]
    if not kept:
        raise InvalidFile(path, "its description ignores every column")
    parts = [_HEADING.fullmatch(meant[index]) for index in kept]
    if (
        wrong := next((i for i, part in enumerate(parts) if not part or not part["name"]), None)
    ) is not None:
        raise InvalidFile(
            path, f"heading {meant[kept[wrong]]!r} is no name with a unit, as 'x [mm]' is"
        )
    names = [part["name"] for part in parts]
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise InvalidFile(path, f"it has more than one column {twice[0]!r}")
    return Table(
        path,
        {name: part["unit"] or "" for name, part in zip(names, parts, strict=True)},
        {
            name: [row[index].strip() for row in rows[1:]]
            for name, index in zip(names, kept, strict=True)
        },
        {
            name: headings[index]
            for name, index in zip(names, kept, strict=True)
            if headings[index] in columns
        },
    )


def _date(cell: str) -> float | None:
    try:
        date = datetime.fromisoformat(cell)
    except ValueError:
        return None
    return (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return math.nan
