"""How controllers write a pose: which numbers, in which units, and what they mean."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import UnknownName
from recalib.files.quantities import ANGLE, LENGTH, NUMBER
from recalib.laboratory.tables.columns import POSITIONS, QUATERNIONS, ROTATION_VECTORS, Columns
from recalib.laboratory.tables.measurements import TURNS

_ORDER = re.compile(r"(?!.*(.)\1)([xyz]{3}|[XYZ]{3})")  # of Euler's angles; no axis twice in a row


@dataclass(frozen=True)
class Convention:
    """A way to write poses.

    Attributes:
        headings: of the rotation, in the order in which the controller shows it.
        turns: the rotations of its numbers (n, k) [rad, 1].
        length, angle: the units, unless the headings of a table have others.
    """

    headings: tuple[str, ...]
    turns: Callable[[np.ndarray], Rotation]
    length: str = ""
    angle: str = ""

    @property
    def layout(self) -> tuple[Columns, Columns]:
        """The columns of a table, all in lower case."""
        kind = ANGLE if len(self.headings) == 3 else NUMBER
        positions = Columns("positions", POSITIONS.headings, LENGTH, unit=self.length, needed=True)
        return positions, Columns("turns", self.headings, kind, unit=self.angle, needed=True)


def _euler(order: str, *headings: str) -> Convention:
    return Convention(headings, partial(Rotation.from_euler, order), "mm", "deg")


scalar_first = partial(Rotation.from_quat, scalar_first=True)
MATRIX = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
CONVENTIONS = {
    "ros": Convention(QUATERNIONS.headings, Rotation.from_quat, "m"),
    "ur": Convention(ROTATION_VECTORS.headings, Rotation.from_rotvec, "m", "rad"),
    "abb": Convention(("q1", "q2", "q3", "q4"), scalar_first, "mm"),
    "kuka": _euler("ZYX", "a", "b", "c"),
    "fanuc": _euler("xyz", "w", "p", "r"),
    "staubli": _euler("XYZ", "rx", "ry", "rz"),
    "matrix": Convention(MATRIX, lambda rows: Rotation.from_matrix(rows.reshape(-1, 3, 3)), "m"),
}
# without a convention, the headings of a table say what they are
OWN = (
    *(Convention(columns.headings, turns) for columns, turns in TURNS.items()),
    *(Convention(("qw", "qx", "qy", "qz"), scalar_first), CONVENTIONS["matrix"]),
)


def convention_of(name: str) -> Convention:
    """The convention of a name, or of an order of Euler's angles such as ZYZ.

    Capitals turn about axes that move, as in SciPy. Raises UnknownName.
    """
    if _ORDER.fullmatch(name):
        return _euler(name, "a", "b", "c")
    if name.lower() not in CONVENTIONS:
        raise UnknownName("convention", name, [*CONVENTIONS, "an order such as ZYZ or xyz"])
    return CONVENTIONS[name.lower()]


def other_readings(numbers: np.ndarray) -> Iterator[tuple[str, Rotation]]:
    """What numbers (n, k) of rotations could mean, in words, and the rotations that they would be.

    Angles may also be degrees that were read as rad, and the other way around.
    """
    if numbers.shape[1] == 4:
        yield "a quaternion w, x, y, z", scalar_first(numbers)
        yield "a quaternion x, y, z, w", Rotation.from_quat(numbers)
    if numbers.shape[1] == 3:
        for scale, unit in ((1.0, ""), (np.pi / 180, " [deg]"), (180 / np.pi, " [rad]")):
            yield f"a rotation vector{unit}", Rotation.from_rotvec(scale * numbers)
            for order in ("ZYX", "xyz", "XYZ", "ZYZ", "ZXZ"):
                axes = f"{'moving' if order.isupper() else 'fixed'} axes {', '.join(order.lower())}"
                yield f"angles about the {axes}{unit}", Rotation.from_euler(order, scale * numbers)
