"""The conventions in which controllers write poses; `recalib calibrate --convention` names one."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import UnknownName
from recalib.laboratory.tables.columns import QUATERNIONS, ROLL_PITCH_YAW, ROTATION_VECTORS

_ORDER = re.compile(r"(?!.*(.)\1)([xyz]{3}|[XYZ]{3})")  # of Euler angles; no axis twice in a row


# from the numbers (n, k) in columns [rad, 1]
TURNS = {
    QUATERNIONS: Rotation.from_quat,
    ROTATION_VECTORS: Rotation.from_rotvec,
    ROLL_PITCH_YAW: partial(Rotation.from_euler, "xyz"),
}


@dataclass(frozen=True)
class Convention:
    """A way to write poses."""

    headings: tuple[str, ...]  # of the rotation, in the controller's order
    turns: Callable[[np.ndarray], Rotation]  # from the rotation's numbers (n, k) [rad, 1]
    length: str = ""  # the unit of lengths in columns whose heading names none
    angle: str = ""  # the unit of angles in columns whose heading names none


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
POSE = (*MATRIX[:3], "x", *MATRIX[3:6], "y", *MATRIX[6:], "z", *(f"last {n}" for n in range(4)))
# conventions that the headings of a table reveal
OWN = (
    *(Convention(columns.headings, turns) for columns, turns in TURNS.items()),
    *(Convention(("qw", "qx", "qy", "qz"), scalar_first), CONVENTIONS["matrix"]),
)


def convention_of(name: str) -> Convention:
    """The convention with this name, or with this order of Euler angles, such as ZYZ.

    Capitals mean moving axes, as in SciPy. Raises UnknownName.
    """
    if _ORDER.fullmatch(name):
        return _euler(name, "a", "b", "c")
    if name.lower() not in CONVENTIONS:
        raise UnknownName("convention", name, [*CONVENTIONS, "an order such as ZYZ or xyz"])
    return CONVENTIONS[name.lower()]


def other_readings(numbers: np.ndarray) -> Iterator[tuple[str, Rotation]]:
    """Other meanings of the numbers (n, k) of rotations, in words, and the resulting rotations.

    These include degrees that were read as radians, and radians that were read as degrees.
    """
    if numbers.shape[1] == 4:
        yield "a quaternion w, x, y, z", scalar_first(numbers)
        yield "a quaternion x, y, z, w", Rotation.from_quat(numbers)
    if numbers.shape[1] == 9:
        yield "transposed", Rotation.from_matrix(numbers.reshape(-1, 3, 3).swapaxes(1, 2))
    if numbers.shape[1] == 3:
        for scale, unit in ((1.0, ""), (np.pi / 180, " [deg]"), (180 / np.pi, " [rad]")):
            yield f"a rotation vector{unit}", Rotation.from_rotvec(scale * numbers)
            for order in ("ZYX", "xyz", "XYZ", "ZYZ", "ZXZ"):
                axes = f"{'moving' if order.isupper() else 'fixed'} axes {', '.join(order.lower())}"
                yield f"angles about the {axes}{unit}", Rotation.from_euler(order, scale * numbers)
