"""Serial arms from tables of Denavit-Hartenberg parameters, standard or modified.

Standard: joint i turns about or slides along the z axis of frame i - 1, and carries the frame

    T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i)        (Denavit and Hartenberg 1955)

Modified: joint i moves about or along the z axis of its own frame, after the link before it:

    T_i = Rx(alpha_i) Tx(a_i) Rz(theta_i) Tz(d_i)        (Craig 1986; a and alpha of link i - 1)

The joint coordinate is added to theta if the joint turns, to d if it slides.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_kind, check_name
from recalib.nominal.kinematics import Arm

CONVENTIONS = "standard", "modified"
MOST = 100  # joints of a serial arm: computing time grows with the cube of their number
BASE, TOOL = "base", "tool"


@dataclass(frozen=True)
class Row:
    """A joint and a link by their Denavit-Hartenberg parameters.

    Attributes:
        name: name of the joint.
        a, d: m.
        alpha, theta: rad.
        slides: whether the joint slides.
    """

    name: str
    a: float = 0.0
    alpha: float = 0.0
    d: float = 0.0
    theta: float = 0.0
    slides: bool = False


def arm_of_table(rows: Sequence[Row], convention: str = "standard") -> Arm:
    """The arm that a table describes. The tool is the frame of the last row.

    Links have no masses, and joints no limits. The first link is called base, the last one tool,
    and the others are named after the joints that move them.

    Raises UnknownName (convention), and InvalidSetting (no rows, too many rows, two joints of the
    same name, a parameter that is not a number).
    """
    check_name("convention of Denavit-Hartenberg parameters", convention, CONVENTIONS)
    _check(rows)
    model = pin.Model()
    _add_link(model, BASE, 0, pin.SE3.Identity())
    after = pin.SE3.Identity()  # from the last joint's frame to the next link
    for row in rows:
        along_x = _screw(0, row.alpha, row.a)
        along_z = _screw(2, row.theta, row.d)
        # A joint's motion commutes with its constant theta and d, so it may come before them.
        if convention == "standard":
            before, behind = after, along_z * along_x
        else:
            before, behind = after * along_x, along_z
        kind = pin.JointModelPZ() if row.slides else pin.JointModelRZ()
        joint = model.addJoint(model.njoints - 1, kind, before, row.name)
        _add_link(model, f"{row.name}_link", joint, pin.SE3.Identity())
        after = behind
    _add_link(model, TOOL, model.njoints - 1, after)
    model.lowerPositionLimit, model.upperPositionLimit = (
        np.full(model.nq, sign * np.inf) for sign in (-1, 1)
    )
    return Arm(model, TOOL, BASE)


def _check(rows: Sequence[Row]) -> None:
    check_kind("rows", rows, Sequence)
    if not 0 < len(rows) <= MOST:
        raise InvalidSetting("rows", f"{len(rows)} joints", f"1 to {MOST}")
    for row in rows:
        check_kind("row", row, Row)
        check_kind("name of a row", row.name, str)
        check_kind(f"slides of {row.name}", row.slides, bool, np.bool_)
    names = [row.name for row in rows]
    for row in rows:
        if names.count(row.name) > 1:
            raise InvalidSetting("name of a row", row.name, "another name for each joint")
        for key in ("a", "alpha", "d", "theta"):
            array_of(f"{key} of {row.name}", getattr(row, key), ())


def _screw(axis: int, angle: float, length: float) -> pin.SE3:
    """A rotation about a coordinate axis and a translation along it."""
    along = np.eye(3)[axis]
    return pin.SE3(pin.exp3(angle * along), length * along)


def _add_link(model: pin.Model, name: str, joint: int, placement: pin.SE3) -> None:
    model.addFrame(pin.Frame(name, joint, placement, pin.FrameType.BODY))
