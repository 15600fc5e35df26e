"""Nominal robots: an arm from a URDF with its tool frame, home, joint limits and workspace."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import pinocchio as pin

from recalib.arrays import array_of, numbers
from recalib.errors import InvalidSetting, UnsuitableRobot, check_kind, check_name
from recalib.nominal.arms import load_arm
from recalib.nominal.descriptions import find_urdf
from recalib.nominal.kinematics import Arm
from recalib.nominal.workspace import Workspace


@dataclass(frozen=True)
class Robot:
    """A nominal robot, as its manufacturer describes it.

    Attributes:
        name: display name.
        urdf: the file that describes the robot.
        arm: its kinematics; joints that do not move the tool are locked.
        home: (joint,) joint angles in rad (m if a joint slides) at the centre of the workspace.
        lower, upper: (joint,) joint limits in rad (m).
        workspace: centred on the home pose.
    """

    name: str
    urdf: Path
    arm: Arm
    home: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    workspace: Workspace

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints, from the base to the tool."""
        return self.arm.joints

    @property
    def links(self) -> dict[str, int]:
        """Index of the joint that moves each link, by the link's name; 0 for the base."""
        return self.arm.links

    @property
    def outward(self) -> np.ndarray:
        """Unit vector (3,) in the tool's frame, along the last joint's axis, away from the arm."""
        return self.arm.end.placement.rotation.T @ _outward(self.arm)


def shown(coordinate: float, slides: bool, digits: str = ".1f") -> str:
    """A joint coordinate [rad], or [m] if the joint slides, as text in degrees or mm."""
    return (
        f"{1e3 * coordinate:{digits}} mm" if slides else f"{math.degrees(coordinate):{digits}} deg"
    )


def link_end(arm: Arm, joint: int) -> pin.SE3:
    """The end of the link after `joint`, in its frame [m]. Changing it changes the arm."""
    if joint < len(arm.joints):
        return arm.model.jointPlacements[joint + 1]
    return arm.end.placement


def _outward(arm: Arm) -> np.ndarray:
    """Unit vector (3,) along the last joint's axis, towards the tool: URDFs define either sign."""
    axis = arm.axes[-1]
    return math.copysign(1, arm.end.placement.translation @ axis) * axis


def load_robot(
    urdf: str | PathLike[str],
    tool: str,
    home: Mapping[str, float],
    position_range: Sequence[float] | np.ndarray,
    orientation_range: Sequence[float] | np.ndarray,
    limits: Mapping[str, tuple[float, float]] | None = None,
    name: str | None = None,
    coordinates: str = "roll_pitch_yaw",
    beyond: float = 0.0,
) -> Robot:
    """The robot that a URDF describes, with a workspace about its home.

    Args:
        urdf: a path, or a name: see `find_urdf`.
        tool: name of the link whose frame is the pose.
        home: rad (m if a joint slides) by joint, at the centre of the workspace.
        position_range: (3,) m, full sizes of the workspace along the base's axes.
        orientation_range: (3,) rad, full ranges of roll, pitch and yaw, or of rotation vectors.
        limits: lowest and highest angle [rad] (or length [m]) by joint, in place of the URDF's.
        name: display name; default: the file's name.
        coordinates: coordinates of orientations; see `Workspace`.
        beyond: m, length of a rigid tool that extends outwards from the tool link, along the last
            joint's axis.

    Raises UnknownName (URDF, tool link, joint, coordinates), UnsuitableRobot (see `load_arm`), and
    InvalidSetting (a joint without a home, a home beyond a joint's limits, a workspace without
    size, or with ambiguous coordinates of orientations).
    """
    path, limits = find_urdf(urdf), {} if limits is None else limits
    array_of("beyond", beyond, ())
    check_kind("name", name, str, type(None))
    arm = load_arm(path, tool)
    end = arm.end.placement.translation
    end += beyond * _outward(arm)
    joints = arm.joints
    if len(arm.coupling.columns) < len(joints):
        followers = f"of {', '.join(joints)} some follow others by <mimic>"
        raise UnsuitableRobot(f"{path.name}: {followers}; expected: a motor for each joint")
    if len(joints) < 6:
        raise UnsuitableRobot(
            f"{path.name} moves {tool!r} with {len(joints)} joints: {', '.join(joints)}; expected:"
            " at least six, for a workspace in which poses have six coordinates"
        )
    for key, given in (("home", home), ("limits", limits)):
        check_kind(key, given, Mapping)
        for joint in given:
            check_name(f"joint in {key}", joint, joints)
    if missing := [joint for joint in joints if joint not in home]:
        raise InvalidSetting("home", dict(home), f"an angle for {', '.join(missing)} too")
    lower, upper = arm.model.lowerPositionLimit.copy(), arm.model.upperPositionLimit.copy()
    for joint, bounds in limits.items():
        pair, index = numbers(f"limits.{joint}", bounds), joints.index(joint)
        if pair.shape != (2,) or not pair[0] <= pair[1]:
            raise InvalidSetting(f"limits.{joint}", bounds, "the lowest and the highest")
        lower[index], upper[index] = pair
    angles = np.array([array_of(f"home.{joint}", home[joint], ()) for joint in joints])
    for joint, slides, low, angle, high in zip(
        joints, arm.slides, lower, angles, upper, strict=True
    ):
        if not low <= angle <= high:
            valid = f"{shown(low, slides)} to {shown(high, slides)}"
            raise InvalidSetting(f"home.{joint}", shown(angle, slides, ".6g"), valid)
    for key, sides in (
        ("position_range", position_range),
        ("orientation_range", orientation_range),
    ):
        if not (array_of(key, sides, (3,)) > 0).all():
            raise InvalidSetting(key, [*sides], "three sides above zero")
    workspace = Workspace(
        centre=arm.forward(angles[None])[0],
        half_ranges=np.array([*position_range, *orientation_range]) / 2,
        coordinates=coordinates,
    )
    return Robot(name or path.stem, path, arm, angles, lower, upper, workspace)
