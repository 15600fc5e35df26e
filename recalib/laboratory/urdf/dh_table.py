"""A table of Denavit-Hartenberg parameters (CSV), and the URDF of its arm."""

import re

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH
from recalib.laboratory.report.templates import render
from recalib.laboratory.tables.columns import TEXT, Columns
from recalib.laboratory.tables.table import read_table
from recalib.laboratory.urdf.origins import origin_element, written
from recalib.nominal.arms import UNBOUNDED
from recalib.nominal.denavit_hartenberg import BASE, MOST, TOOL, Row
from recalib.nominal.kinematics import Arm

MOUNT = f"{TOOL}_mount"  # the joint between the last link and the tool
KINDS = "revolute", "prismatic"
NO_XML = re.compile(r"[^ -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
PARAMETERS = {"a": LENGTH, "alpha": ANGLE, "d": LENGTH, "theta": ANGLE}
RIGHT, ROUNDED = np.pi * np.array([0.5, 1.0]), 2e-3  # a right angle or two in rad, as people write
MOST_RAD = 7.0  # of an angle: a larger number is of degrees
LAYOUT = (
    Columns("joint", ("joint",), TEXT, needed=True),
    *(Columns(name, (name,), quantity, needed=True) for name, quantity in PARAMETERS.items()),
    Columns("kind", ("kind",), TEXT),
)


def read_rows(path: AnyPath) -> list[Row]:
    """The rows of the table at `path`, from the base to the tool.

    The columns are `joint`, a name; `a` and `d`, lengths; `alpha` and `theta`, angles; and, if
    joints slide, `kind`: revolute or prismatic.

    Raises InvalidFile: not a table, a missing or unknown column, a wrong unit, an invalid cell.
    """
    table = read_table(path)
    columns = table.read(LAYOUT)
    turns = np.degrees([columns["alpha"], columns["theta"]])
    gaps = np.abs(np.abs(turns)[..., None] - RIGHT).min(axis=-1)
    if np.abs(turns).max() < MOST_RAD and gaps.min() < ROUNDED:
        found = f"its angles, such as {turns.flat[gaps.argmin()]:.4g} deg, are right angles in rad"
        raise InvalidFile(path, f"{found}; expected: alpha [rad] and theta [rad], or degrees")
    names = columns["joint"].tolist()
    if len(table) > MOST:
        raise InvalidFile(path, f"it has {len(table)} joints; expected: at most {MOST}")
    kinds = columns["kind"].tolist() if "kind" in columns else [KINDS[0]] * len(table)
    for row, (name, kind) in enumerate(zip(names, kinds, strict=True), 1):
        if name in ("", MOUNT):
            found = "is empty" if not name else f"is {MOUNT!r}, the name of the tool's joint"
            raise InvalidFile(path, f"row {row} of column 'joint' {found}; try: another name")
        if NO_XML.search(name):
            found = f"row {row} of column 'joint' is {name!r}"
            raise InvalidFile(path, f"{found}, with a character that XML does not allow")
        if kind not in KINDS:
            valid = " or ".join(KINDS)
            raise InvalidFile(path, f"row {row} of column 'kind' is {kind!r}; expected: {valid}")
    numbers = zip(*(columns[name].tolist() for name in PARAMETERS), strict=True)
    return [
        Row(name, **dict(zip(PARAMETERS, row, strict=True)), slides=kind == KINDS[1])
        for name, kind, row in zip(names, kinds, numbers, strict=True)
    ]


def urdf_of(arm: Arm) -> str:
    """The URDF of an arm, without masses and limits: a link for each joint, and the tool."""
    origins = [origin_element(pose.homogeneous) for pose in arm.model.jointPlacements[1:]]
    joints = [*zip(arm.joints, arm.slides, map(written, arm.axes), origins, strict=True)]
    end = origin_element(arm.end.placement.homogeneous)
    mounted = {"tool": TOOL, "mount": MOUNT, "mounted": end}
    return render("arm.urdf.j2", base=BASE, joints=joints, unbounded=UNBOUNDED, **mounted)
