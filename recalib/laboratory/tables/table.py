"""A table (CSV) whose header names each column and its unit: `elbow_joint [deg]`, `x [mm]`."""

import csv
import io
import math
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, TIME, Quantity
from recalib.files.storage import read_file
from recalib.laboratory.tables.columns import NAME, TEXT, Columns
from recalib.spelling import counted, instead, listed

_HEADING = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[\s*(?P<unit>[^\[\]]*?)\s*\])?\s*")
IGNORED = "ignored"
SEPARATORS = {";": "semicolons", "\t": "tabs"}  # that some programs write in place of commas
MOST, MOST_ROWS = 32_000_000, 10_000  # bytes; rows, which take about an hour to calibrate from


@dataclass(frozen=True)
class Table:
    """The cells of a table, by column. Rows are counted from 1, without the header."""

    path: Path  # of the file, for messages
    units: Mapping[str, str]  # of each column; empty if the header names none
    cells: Mapping[str, list[str]]  # of each column, one for each row
    headings: Mapping[str, str]  # of each column in the file; a description may rename it

    def __len__(self) -> int:
        return len(next(iter(self.cells.values())))

    def __contains__(self, column: str) -> bool:
        return column in self.cells

    def read(
        self, layout: Sequence[Columns], others: Sequence[str] = (), note: str = ""
    ) -> dict[str, np.ndarray]:
        """The arrays of all columns by `Columns.name`: (n,) of a single column, else (n, k).

        The table may have the columns of the layout and `others`. The note explains, in messages,
        why a column with an angle is unknown. Raises InvalidFile: unknown or missing columns, a
        wrong unit, an invalid cell.
        """
        valid = [*others, *(heading for columns in layout for heading in columns.headings)]
        for column in self.cells:
            if column not in valid:
                bracketed = "expected: its unit in square brackets, as in 'x [mm]'"
                why = note if self.units[column] in ANGLE.units else ""  # it may be a joint
                right = bracketed if column.endswith(")") else instead(column, valid)
                raise InvalidFile(self.path, f"unknown column {column!r}{why}; {right}")
        arrays = {}
        for columns in layout:
            missing = [heading for heading in columns.headings if heading not in self]
            if not missing:
                parts = [self._values(heading, columns) for heading in columns.headings]
                arrays[columns.name] = parts[0] if len(parts) == 1 else np.stack(parts, axis=1)
            elif len(missing) < len(columns.headings):
                are = "is" if len(missing) == 1 else "are"
                together = f"{listed(columns.headings, 'and')} are needed together"
                reason = f"{listed(missing, 'and')} {are} missing: {together}"
                raise InvalidFile(self.path, reason)
            elif columns.needed:
                meaning = f": {columns.meaning}" if columns.meaning else ""
                raise InvalidFile(self.path, f"column {missing[0]!r} is missing{meaning}")
        return arrays

    def _values(self, column: str, kind: Columns) -> np.ndarray:
        if kind.quantity is TEXT:
            return np.array(self.cells[column])
        if kind.quantity is NAME:
            return self._names(column)
        if kind.quantity is TIME and not self.units[column]:
            return self._dates(column)
        return self.numbers(column, kind.quantity)

    def numbers(self, column: str, quantity: Quantity) -> np.ndarray:
        """The numbers (n,) in a column, in SI units. Raises InvalidFile like `read`."""
        unit = self.units[column]
        if unit not in quantity.units:
            found = f"is in {unit!r}" if unit else "names no unit"
            units = sorted(quantity.units)
            valid = listed((f"{column} [{unit}]" if unit else column for unit in units), "or")
            raise InvalidFile(self.path, f"column {column!r} {found}; expected: {valid}")
        numbers = np.array([number_in(cell) for cell in self.cells[column]])
        self._check(column, np.isfinite(numbers), "expected: a number")
        numbers *= quantity.units[unit]
        if np.isfinite(quantity.farthest):
            valid = f"expected: up to {quantity.write(quantity.farthest)}. Is its unit right?"
            self._check(column, np.abs(numbers) <= quantity.farthest, valid, unit)
        return numbers

    def _dates(self, column: str) -> np.ndarray:
        """The dates (n,) in a column, as seconds since 1970."""
        dates = np.array([_date(cell) for cell in self.cells[column]])
        valid = f"expected: a date such as 2026-11-23T08:15:00.5, or seconds in {column} [s]"
        self._check(column, np.isfinite(dates), valid)
        return dates

    def _names(self, column: str) -> np.ndarray:
        first: dict[str, str] = {}
        for row, label in enumerate(self.cells[column], 1):
            if not label:
                reason = f"row {row} of column {column!r} is empty; expected: a name"
                raise InvalidFile(self.path, reason)
            if label != (other := first.setdefault(label.casefold(), label)):
                raise InvalidFile(
                    self.path,
                    f"{other!r} and {label!r} of column {column!r} differ only in capitals;"
                    " expected: one spelling",
                )
        return np.array(self.cells[column])

    def _check(self, column: str, good: np.ndarray, valid: str, unit: str | None = None) -> None:
        """Raise InvalidFile about the first cell that is not good (n,)."""
        if not good.all():
            row = int(good.argmin())
            cell = self.cells[column][row]
            found = repr(cell) if unit is None else f"{cell} {unit}"
            place = f"row {row + 1} of column {self.headings[column]!r}"
            raise InvalidFile(self.path, f"{place} is {found}; {valid}")


def read_table(
    path: AnyPath, columns: Mapping[str, str] | None = None, most: int = MOST_ROWS
) -> Table:
    """The table at `path`; see `table_of`. Raises InvalidFile."""
    return table_of(read_file(path, MOST), path, columns, most)


def table_of(
    content: bytes, path: AnyPath, columns: Mapping[str, str] | None = None, most: int = MOST_ROWS
) -> Table:
    """Parse the content of a file: UTF-8, commas between cells, a header, rows below it.

    Args:
        columns: maps a heading of the file to the heading that it should have, or "ignored".

    Raises InvalidFile: it is not such a table, or lacks a heading in `columns`.
    """
    path, columns = Path(path), columns or {}
    try:
        lines = csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""))
        filled = (row for row in lines if any(cell.strip() for cell in row))
        rows = list(islice(filled, most + 2))
    except (UnicodeDecodeError, csv.Error):
        raise InvalidFile(path, "it is not CSV in UTF-8") from None
    if len(rows) > most + 1:
        raise InvalidFile(path, f"it has more than {most} rows; try: every tenth of them")
    if len(rows) < 2:
        raise InvalidFile(path, "it is empty" if not rows else "it has a header but no rows")
    found = [cell.strip() for cell in rows[0]]
    for separator, name in SEPARATORS.items():
        if len(found) == 1 and separator in found[0]:
            raise InvalidFile(path, f"its columns are separated by {name}; expected: commas")
    if unknown := [heading for heading in columns if heading not in found]:
        described = f"its description names column {unknown[0]!r}"
        raise InvalidFile(path, f"{described}; the table has {', '.join(found)}")
    for row, line in enumerate(rows[1:], 1):
        if len(line) != len(found):
            cells = counted(len(line), "cell")
            header = f"as in the header, which begins with {found[0]!r}"
            reason = f"row {row} has {cells}; expected: {len(found)}, {header}"
            raise InvalidFile(path, reason)
    units: dict[str, str] = {}
    cells_of: dict[str, list[str]] = {}
    headings: dict[str, str] = {}
    for index, heading in enumerate(found):
        meant = columns.get(heading, heading)
        if meant == IGNORED:
            continue
        if not meant and not heading:
            raise InvalidFile(path, f"column {index + 1} has no heading")
        parts = _HEADING.fullmatch(meant)
        if not parts or not parts["name"]:
            valid = "expected: a name, and its unit in square brackets, as in 'x [mm]'"
            raise InvalidFile(path, f"heading {meant!r} cannot be used; {valid}")
        name = named(parts["name"])
        if name in cells_of:
            raise InvalidFile(path, f"it has more than one column {name!r}")
        units[name], cells_of[name] = parts["unit"] or "", [row[index].strip() for row in rows[1:]]
        headings[name] = heading if heading in columns else name
    if not cells_of:
        raise InvalidFile(path, "its description ignores every column")
    return Table(path, units, cells_of, headings)


def named(name: str) -> str:
    """A name as headings have it: without blanks at its ends, a letter with its accent as one."""
    return unicodedata.normalize("NFC", name.strip())


def table_text(rows: Iterable[Mapping[str, object]]) -> bytes:
    """The CSV text of one or more rows: cells by heading, in the same order in each row."""
    rows, text = list(rows), io.StringIO(newline="")
    writer = csv.DictWriter(text, fieldnames=rows[0], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode("utf-8")


def _date(cell: str) -> float:
    try:
        date = datetime.fromisoformat(cell)
    except ValueError:
        return math.nan
    return (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()


def number_in(cell: str) -> float:
    """The number in a cell; NaN without one. Python reads 1_0 as ten; other programs do not."""
    try:
        return math.nan if "_" in cell else float(cell)
    except ValueError:
        return math.nan
