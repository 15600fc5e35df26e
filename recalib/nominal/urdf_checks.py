"""Mistakes in URDFs that Pinocchio does not name: closed chains, and numbers that are none."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from recalib.errors import UnsuitableRobot
from recalib.nominal.coupling import MOVING

SHORTEST = 1e-6  # of an axis: Pinocchio may not normalise a shorter one
MOST_TURN = 4 * np.pi  # rad in an origin: more are degrees
NUMBERS = {  # attributes of joints and inertials
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "limit": ("lower", "upper"),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "mimic": ("multiplier", "offset"),
}
ERROR = "Error:"  # before what urdfdom finds wrong


def check_description(robot: Element, path: Path) -> None:
    """Raise UnsuitableRobot unless links are a tree, and joints and masses have finite numbers.

    Names of links and joints have to be words that a message and a table can show.
    """
    carried: dict[str, str] = {}
    for part in (*robot.iterfind("link"), *robot.iterfind("joint")):
        if not (name := part.get("name", "-")).strip() or not name.isprintable():
            raise UnsuitableRobot(
                f"a {part.tag} in {path} has the name {part.get('name')!r}; expected: letters that"
                " can be printed"
            )
    for joint in robot.iterfind("joint"):
        child, name = joint.find("child"), joint.get("name", "")
        link = "" if child is None else child.get("link", "")
        if link in carried:
            raise UnsuitableRobot(
                f"{link} is the child of two joints, {carried[link]} and {name}, in {path}: a"
                " closed chain; expected: a tree"
            )
        carried |= {link: name} if link else {}
    for part in robot:
        for element in (inner for place in (part, *part.findall("inertial")) for inner in place):
            for key in NUMBERS.get(element.tag, ()):
                numbers, text = _numbers(element.get(key, "0")), element.get(key)
                found = f"the {element.tag} of {part.get('name')} in {path} has {key} {text!r}"
                if not numbers:
                    raise UnsuitableRobot(f"{found}; expected: a number")
                if key == "rpy" and np.abs(numbers).max() > MOST_TURN:
                    raise UnsuitableRobot(f"{found}; expected: rad, not degrees")
                axis = element.tag == "axis" and part.get("type") in MOVING
                if axis and not SHORTEST < np.abs(numbers).max() < 1 / SHORTEST:
                    reason = f"the axis of {part.get('name')} has no length"
                    raise UnsuitableRobot(f"{reason} in {path}")


def mistakes(robot: Element, messages: list[str]) -> Iterator[str]:
    """What is wrong with a URDF: vectors of other lengths, and then what urdfdom wrote."""
    for part in robot:
        vectors = ((inner, key, inner.get(key)) for inner in part.iter() for key in ("xyz", "rpy"))
        for element, key, text in vectors:
            if text is not None and len(_numbers(text) or ()) != 3:
                where = f"the {element.tag} of {part.get('name')}"
                yield f"{where} has {key} {text!r}; expected: three numbers"
    for line in messages:
        if line.startswith(ERROR):
            yield line.removeprefix(ERROR).strip().rstrip(".")


def _numbers(text: str) -> list[float] | None:
    """The numbers in a text; None unless all of it are finite numbers."""
    try:
        numbers = [float(number) for number in text.split()]
    except ValueError:
        return None
    return numbers if np.isfinite(numbers).all() else None
