"""Serial arms from URDFs: the joints between a base link and a tool link; all others are locked."""

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import NoReturn
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from recalib.errors import InvalidSetting, UnsuitableRobot, check_name
from recalib.files.storage import read_file
from recalib.nominal.descriptions import (
    MOST,
    MOVING,
    caught_messages,
    check_description,
    find_urdf,
    link_of,
    mistakes,
    parsed,
)
from recalib.nominal.kinematics import Arm, Coupling, tool_frame
from recalib.spelling import listed

KINDS = "fixed", *MOVING
NAMESAKE = " (joint)"  # suffix for a joint that has the same name as a link
MOST_MOVING = 100  # joints between base and tool: computing time grows with the cube of the number
UNBOUNDED = 1e300  # stands for "no limit"; urdfdom can read this number
FARTHEST, HEAVIEST = 50.0, 1e6  # m from a joint to the next, to the tool or a link's centre; kg


def load_arm(urdf: str | PathLike[str], tool: str | None = None, base: str | None = None) -> Arm:
    """The serial arm from a base link to a tool link; its joints turn or slide.

    Other joints are locked at neutral. A turning joint without limits gets infinite limits. Gravity
    acts along -z of the URDF's root, whichever link is the base.

    Args:
        urdf: see `find_urdf`.
        tool: link whose frame is the pose; default: the only end of the arm.
        base: link in whose frame poses are expressed; default: the root.

    Raises UnknownName (URDF, link), InvalidFile (no such file), InvalidSetting (several ends, and
    no tool), and UnsuitableRobot (not a URDF, or no such arm in it).
    """
    path = find_urdf(urdf)
    return arm_of(read_file(path, MOST), path, tool, base)


def arm_of(source: bytes, path: Path, tool: str | None = None, base: str | None = None) -> Arm:
    """Like `load_arm`, from the content of a URDF; `path` is only for messages."""
    tree = _Tree(source, path)
    base = tree.link("base", base or tree.root)
    tool = tree.only_end(base) if tool is None else tree.link("tool", tool)
    moving = tree.joints_between(base, tool)
    locked = [joint for joint, name in enumerate(tree.model.names) if joint and name not in moving]
    model = pin.buildReducedModel(tree.model, locked, pin.neutral(tree.model))
    for limits in (model.lowerPositionLimit, model.upperPositionLimit):
        limits[np.abs(limits) >= UNBOUNDED] *= np.inf
    for index, name in enumerate(model.names):
        model.names[index] = name.removesuffix(NAMESAKE)
    if base != tree.root:
        _stand_on(model, model.frames[tool_frame(model, base)].placement.copy())
    limits = np.array([model.lowerPositionLimit, model.upperPositionLimit])
    arm = Arm(model, tool, base, _coupling_of(tree.joints, list(model.names)[1:], limits))
    _check(arm, path)
    return arm


def _coupling_of(
    joints: Mapping[str, ElementTree.Element], names: Sequence[str], limits: np.ndarray
) -> Coupling | None:
    """The coupling of joints by `<mimic>`; None if no joint follows another.

    `joints` are all joints of a URDF; `names` and `limits` (2, joint) [rad, m] are of the arm's.
    """
    if all(joints[name].find("mimic") is None for name in names):
        return None
    drivers, gains, shifts = zip(*(_followed(joints, name) for name in names), strict=True)
    columns = tuple(dict.fromkeys(drivers))
    matrix = np.zeros((len(names), len(columns)))
    matrix[np.arange(len(names)), [columns.index(driver) for driver in drivers]] = gains
    bounds = np.array([_limits(joints[column]) for column in columns]).T
    for driver, gain, shift, ends in zip(drivers, gains, shifts, limits.T, strict=True):
        if gain:
            lower, upper = sorted((ends - shift) / gain)
            column = bounds[:, columns.index(driver)]
            column[:] = max(column[0], lower), min(column[1], upper)
    slides = np.array([joints[column].get("type") == "prismatic" for column in columns])
    return Coupling(columns, slides, matrix, np.array(shifts), bounds)


def _followed(joints: Mapping[str, ElementTree.Element], name: str) -> tuple[str, float, float]:
    """The joint that drives another, and the factor and offset of the coupling."""
    gain, shift, chain = 1.0, 0.0, [name]
    while (mimic := joints[chain[-1]].find("mimic")) is not None:
        shift += gain * float(mimic.get("offset", "0"))
        gain *= float(mimic.get("multiplier", "1"))
        driver = mimic.get("joint", "")
        if driver in chain or driver not in joints or joints[driver].get("type") not in MOVING:
            raise UnsuitableRobot(
                f"{chain[-1]} follows {driver!r}; expected: another joint, which moves by itself"
            )
        chain.append(driver)
    return chain[-1], gain, shift


def _limits(joint: ElementTree.Element) -> tuple[float, float]:
    limit = joint.find("limit")
    if limit is None or joint.get("type") == "continuous":
        return -np.inf, np.inf
    lower, upper = (float(limit.get(end, "0")) for end in ("lower", "upper"))
    return lower, upper


def _check(arm: Arm, path: Path) -> None:
    """Raise UnsuitableRobot if a number of an arm is implausible."""
    model = arm.model
    limits = model.lowerPositionLimit, model.upperPositionLimit
    for joint, lower, upper in zip(arm.joints, *limits, strict=True):
        if not lower <= upper:
            found = f"the limits of {joint} are {lower} to {upper} in {path}"
            raise UnsuitableRobot(f"{found}; expected: the lower one first")
    placements = [*model.jointPlacements[1:], arm.end.placement]
    for name, placement in zip([*arm.joints, arm.tool], placements, strict=True):
        if not np.abs(placement.translation).max() < FARTHEST:
            far = f"{FARTHEST:g} m or more from what carries it"
            raise UnsuitableRobot(f"{name} is {far} in {path}; are its lengths in m?")
    for name, inertia in zip(arm.joints, list(model.inertias)[1:], strict=True):
        if not 0 <= inertia.mass < HEAVIEST:
            raise UnsuitableRobot(f"what {name} carries has no mass of an arm's link in {path}")
        if not np.abs(inertia.lever).max() < FARTHEST:
            far = f"has its centre {FARTHEST:g} m or more away"
            raise UnsuitableRobot(f"what {name} carries {far} in {path}; are its lengths in m?")


class _Tree:
    """The links and joints of a URDF.

    Attributes:
        model: Pinocchio's model. Continuous joints are revolute joints with limits out of reach,
            because Pinocchio gives a continuous joint two coordinates, cosine and sine.
        root: the link that no joint carries.
        joints: XML elements by joint name.
    """

    def __init__(self, source: bytes, path: Path):
        robot = parsed(source, path)
        if path.suffix == ".xacro" or any("xacro" in element.tag for element in robot.iter()):
            raise UnsuitableRobot(f"{path} is a xacro file; try: the output of `xacro {path.name}`")
        links = {link.get("name", "") for link in robot.iterfind("link")}
        for joint in robot.iterfind("joint"):
            if joint.get("type") == "continuous":
                _bound(joint)
            name = joint.get("name", "")
            if name in links:  # Pinocchio confuses frames with the same name
                joint.set("name", name + NAMESAKE)
        check_description(robot, path)
        try:
            with caught_messages() as messages:
                self.model = pin.buildModelFromXML(ElementTree.tostring(robot, encoding="unicode"))
        except (ValueError, RecursionError):
            reasons = [f"{path} is not a URDF that Pinocchio can read", *mistakes(robot, messages)]
            raise UnsuitableRobot(": ".join(reasons[:2])) from None
        self._name = path.name
        self._joints = {link_of(joint, "child"): joint for joint in robot.iterfind("joint")}
        self.joints = {
            joint.get("name", "").removesuffix(NAMESAKE): joint for joint in robot.iterfind("joint")
        }
        # Pinocchio has no frames for links in a loop, which no root carries
        bodies = [frame for frame in self.model.frames if frame.type == pin.FrameType.BODY]
        self._links = [frame.name for frame in bodies]
        self._circles = sorted(links.difference(self._links))
        self.root = self._links[0]

    def link(self, role: str, name: str) -> str:
        """The name itself, once checked. Raises UnknownName, or UnsuitableRobot (in a loop)."""
        if name in self._circles:
            self._refuse_circles()
        check_name(f"{role} link of {self._name}", name, self._links)
        return name

    def _refuse_circles(self) -> NoReturn:
        found = f"{listed(self._circles, 'and')} of {self._name} hang in a circle, on no base"
        raise UnsuitableRobot(f"{found}; expected: a tree")

    def only_end(self, base: str) -> str:
        """The only link without children that a joint moves against the base."""
        if self._circles:  # the arm may be in a loop
            self._refuse_circles()
        carrying = {link_of(joint, "parent") for joint in self._joints.values()}
        ends = [
            link
            for link in self._links
            if link not in carrying
            and any(joint.get("type") != "fixed" for joint in self._joints_up(link, base) or ())
        ]
        if not ends:
            raise UnsuitableRobot(f"no joint of {self._name} moves a link that hangs on {base}")
        if len(ends) != 1:
            valid = f"a link of {self._name}; at its ends are {', '.join(ends)}"
            raise InvalidSetting("tool", None, valid)
        return ends[0]

    def joints_between(self, base: str, tool: str) -> list[str]:
        """Names of the joints that move the tool relative to the base."""
        between = self._joints_up(tool, base)
        if between is None:
            raise UnsuitableRobot(f"{base} does not carry {tool} in {self._name}")
        moving = []
        for joint in between:
            kind = joint.get("type")
            if kind not in KINDS:
                raise UnsuitableRobot(
                    f"the joint {joint.get('name')} between {base} and {tool} of {self._name} is"
                    f" {kind}; expected: {', '.join(KINDS)}"
                )
            if kind != "fixed":
                moving.append(joint.attrib["name"])
        if len(moving) > MOST_MOVING:
            found = f"{len(moving)} joints of {self._name} move {tool} against {base}"
            raise UnsuitableRobot(f"{found}; expected: at most {MOST_MOVING}")
        if not moving:
            raise UnsuitableRobot(f"no joint of {self._name} moves {tool} against {base}")
        return moving

    def _joints_up(self, link: str, base: str) -> list[ElementTree.Element] | None:
        """The joints from a link up to a base; None if the base does not carry it."""
        joints = []
        while link != base:
            if link not in self._joints:
                return None
            joints.append(self._joints[link])
            link = link_of(joints[-1], "parent")
        return joints


def _bound(joint: ElementTree.Element) -> None:
    """Turn a continuous joint into a revolute joint with limits out of reach."""
    joint.set("type", "revolute")
    limit = joint.find("limit")
    if limit is None:
        limit = ElementTree.SubElement(joint, "limit", effort="0", velocity="0")
    limit.set("lower", str(-UNBOUNDED))
    limit.set("upper", str(UNBOUNDED))


def _stand_on(model: pin.Model, base: pin.SE3) -> None:
    """Move the model's world frame to its base link; `base` is the link's pose in the old frame."""
    back = base.inverse()
    model.jointPlacements[1] = back * model.jointPlacements[1]
    for frame in model.frames:
        if frame.parentJoint == 0:
            frame.placement = back * frame.placement
    model.gravity.linear = base.rotation.T @ model.gravity.linear
