"""Tables of poses whose columns have the headings of a convention, from files as people have them.

Numbers alone, numbers after their names, lines with headings of other programs, YAML and JSON
become tables with positions and rotations, or matrices.
"""

import re
from dataclasses import replace
from itertools import chain

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import LENGTH
from recalib.laboratory.hand_eye.pose_files import read_text
from recalib.laboratory.tables.columns import PICTURE, POSITIONS
from recalib.laboratory.tables.conventions import CONVENTIONS, POSE, Convention
from recalib.laboratory.tables.records import NAMED, Rows, cells_of, poses_in
from recalib.laboratory.tables.table import Table, number_in, table_of

FEWEST = 6  # headings of a pose: fewer words are a remark
_LABEL = re.compile(r"^\s*[A-Za-z_][^\n\[\]{},;:=]*:?[:=]|\w*array(?=\()", re.MULTILINE)
_LIST = re.compile(r"\[\s*[-.\d\[]")
_LETTERS = re.compile(r"[a-df-zA-DF-Z]")  # without e, which is in 1e-3
_NAN = re.compile(r"\b(nan|inf|infinity)\b", re.IGNORECASE)


def headed_table(path: AnyPath, way: Convention | None, targets: bool) -> Table:
    """The table of the poses in files, see `read_poses`. Raises InvalidFile."""
    headings = way.headings if way else ()
    text, rows = read_text(path, targets, headings)
    if rows:
        return _headed(rows, path, way)
    if ";" in (head := text.partition("\n")[0]) and not _LIST.search(head):  # commas are decimal
        text = text.replace(",", ".").replace(";", ",")
    lines = [*filter(cells_of, _LABEL.sub("", text).splitlines())]
    lines = [line for line in lines if _is_row(line) or len(cells_of(line)) >= FEWEST] or lines
    if not lines:
        raise InvalidFile(path, "it is empty")
    if _is_row(lines[0]):
        return _headed([*map(cells_of, lines)], path, way)
    table = table_of(_separated(lines).encode(), path)
    lengths = {unit for unit in table.units.values() if unit in LENGTH.units}
    if "x" in table or len(lengths) > 1 or "deg" in table.units.values():
        return table
    cells = zip(*table.cells.values(), strict=True)
    records = [dict(zip(table.cells, row, strict=True)) for row in cells]
    if not (rows := poses_in(records, targets, headings)):
        return table
    table, unit = _headed(rows, path, way), next(iter(lengths), "")
    return replace(table, units={**table.units, **dict.fromkeys("xyz", unit)})


def _is_row(line: str) -> bool:
    """Whether a line has numbers, and is no heading."""
    numbers = any(np.isfinite(number_in(cell)) for cell in cells_of(line))
    return numbers or not _LETTERS.search(_NAN.sub("", line))


def _separated(lines: list[str]) -> str:
    """The text of a table with headings in small letters, and commas between cells."""
    head = re.sub(r"\((mm|cm|m|deg|rad)\)", r"[\1]", re.sub("^(?=,)", "row", lines[0].lower()))
    between = r"(?!)" if "," in head else "\t" if "\t" in head else r"[ \t]+"
    return re.sub(rf"(?<=\S){between}(?=\S)", ",", "\n".join([head, *lines[1:]]))


def _headed(rows: Rows, path: AnyPath, way: Convention | None) -> Table:
    """A table of numbers alone: a pose in each row, or a matrix in each three or four."""
    # fewer whole numbers count the poses, or number one
    least = 4 if max(map(len, rows)) == 4 else 2
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
    return table_of("\n".join(map(",".join, zip(*columns, strict=True))).encode(), path)
