"""Tables of poses from a controller or a camera."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH, NUMBER
from recalib.laboratory.hand_eye.headed import headed_table
from recalib.laboratory.tables.columns import PICTURES, POSITIONS, Columns
from recalib.laboratory.tables.conventions import MATRIX, OWN, convention_of
from recalib.laboratory.tables.table import Table, number_in
from recalib.spelling import listed

NORMS = {4: 1.0, 9: 3**0.5}  # of quaternions and of rotation matrices, by their count of numbers
SKEW = 0.02  # relative error of a norm, from rounding
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
    table = headed_table(path, way, targets)
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
