"""How controllers write a pose: which numbers, in which units, and what they mean."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import permutations

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import UnknownName
from recalib.files.quantities import ANGLE, LENGTH, NUMBER
from recalib.laboratory.tables.columns import POSITIONS, Columns

Turns = Callable[[np.ndarray], Rotation]
AXES = "xyz"


def scalar_first(numbers: np.ndarray) -> Rotation:
    """Rotations of quaternions (n, 4) w, x, y, z."""
    return Rotation.from_quat(numbers, scalar_first=True)


def of_matrices(numbers: np.ndarray) -> Rotation:
    """Rotations of matrices (n, 9), row by row."""
    return Rotation.from_matrix(numbers.reshape(-1, 3, 3))


@dataclass(frozen=True)
class Convention:
    """A way to write poses.

    Attributes:
        length, angle: the units, unless the headings of a table have others.
        headings: of the rotation, in the order in which the controller shows it.
        turns: the rotations of its numbers (n, k) [rad, 1].
    """

    length: str
    angle: str
    headings: tuple[str, ...]
    turns: Turns

    @property
    def layout(self) -> tuple[Columns, Columns]:
        """The columns of a table, all in lower case."""
        kind = ANGLE if len(self.headings) == 3 else NUMBER
        positions = Columns("positions", POSITIONS.headings, LENGTH, unit=self.length, needed=True)
        return positions, Columns("turns", self.headings, kind, unit=self.angle, needed=True)


VECTOR, QUATERNION = "a rotation vector", "a quaternion x, y, z, w"
SCALAR_FIRST = "a quaternion w, x, y, z"
MATRIX = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))


def _angles(order: str) -> Turns:
    return partial(Rotation.from_euler, order)


def _meaning(order: str) -> str:
    kind = "moving" if order.isupper() else "fixed"
    return f"angles about the {kind} axes {', '.join(order.lower())}"


CONVENTIONS = {
    "ros": Convention("m", "", ("qx", "qy", "qz", "qw"), Rotation.from_quat),
    "ur": Convention("m", "rad", ("rx", "ry", "rz"), Rotation.from_rotvec),
    "abb": Convention("mm", "", ("q1", "q2", "q3", "q4"), scalar_first),
    "kuka": Convention("mm", "deg", ("a", "b", "c"), _angles("ZYX")),
    "fanuc": Convention("mm", "deg", ("w", "p", "r"), _angles("xyz")),
    "staubli": Convention("mm", "deg", ("rx", "ry", "rz"), _angles("XYZ")),
    "matrix": Convention("m", "", MATRIX, of_matrices),
}
ORDERS = tuple(
    "".join(order)
    for axes in (AXES, AXES.upper())
    for order in (*permutations(axes), *((a, b, a) for a, b in permutations(axes, 2)))
)
# without a convention, the headings of a table say what they are
OWN = (
    Convention("", "", ("qx", "qy", "qz", "qw"), Rotation.from_quat),
    Convention("", "", ("qw", "qx", "qy", "qz"), scalar_first),
    Convention("", "", ("rx", "ry", "rz"), Rotation.from_rotvec),
    Convention("", "", ("roll", "pitch", "yaw"), _angles("xyz")),
)


def convention_of(name: str) -> Convention:
    """The convention of a name, or of an order of Euler's angles such as ZYZ.

    Capitals turn about axes that move, as in SciPy. Raises UnknownName.
    """
    if name in ORDERS:
        return Convention("mm", "deg", ("a", "b", "c"), _angles(name))
    if name.lower() not in CONVENTIONS:
        raise UnknownName("convention", name, [*CONVENTIONS, "an order such as ZYZ or xyz"])
    return CONVENTIONS[name.lower()]


def headings_of(name: str | None) -> tuple[str, ...]:
    """The headings of poses by a convention; none if they are ours. Raises UnknownName."""
    return () if name is None else (*POSITIONS.headings, *convention_of(name).headings)


def other_readings(numbers: np.ndarray) -> Iterator[tuple[str, Rotation]]:
    """What numbers (n, k) of rotations could mean, in words, and the rotations that they would be.

    Angles may also be degrees that were read as rad, and the other way around.
    """
    if numbers.shape[1] == 4:
        yield SCALAR_FIRST, scalar_first(numbers)
        yield QUATERNION, Rotation.from_quat(numbers)
    if numbers.shape[1] == 3:
        for scale, unit in ((1.0, ""), (np.pi / 180, " [deg]"), (180 / np.pi, " [rad]")):
            yield VECTOR + unit, Rotation.from_rotvec(scale * numbers)
            for order in ("ZYX", "xyz", "XYZ", "ZYZ", "ZXZ"):
                yield _meaning(order) + unit, Rotation.from_euler(order, scale * numbers)
