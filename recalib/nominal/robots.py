"""Nominal robots: arms of example-robot-data with their tool frame, home, joint limits and workspace."""

import importlib.metadata
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pinocchio as pin

from recalib import quantities
from recalib.errors import InvalidSetting, UnknownName, UnsuitableRobot
from recalib.nominal.kinematics import Arm, tool_frame
from recalib.nominal.poses import Workspace

JOINTS = 6


@dataclass(frozen=True)
class Robot:
    """A nominal robot as its manufacturer describes it.

    Attributes:
        name: its key in the configuration.
        urdf: the file that describes it.
        arm: its kinematics, with the joints that do not move the tool locked.
        home: (6,) joint angles in rad at the centre of the workspace.
        lower, upper: (6,) joint limits in rad.
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
        """The six joints, from the base to the tool."""
        return tuple(self.arm.model.names)[1:]

    @property
    def links(self) -> dict[str, int]:
        """Each link, with the joint that moves it (0: the base): it ends at the next joint or the tool."""
        model = self.arm.model
        links: dict[str, int] = {}
        for frame in model.frames:
            is_link = frame.type == pin.FrameType.BODY and frame.name != "world"
            if is_link and frame.parentJoint not in links.values():
                links[frame.name] = frame.parentJoint
        return links


def link_end(model: pin.Model, tool: str, joint: int) -> np.ndarray:
    """Where the link behind `joint` ends, (3,) in m in that joint's frame: a view that can be written to."""
    if joint < JOINTS:
        return model.jointPlacements[joint + 1].translation
    return model.frames[tool_frame(model, tool)].placement.translation


@cache
def _urdf_files() -> dict[str, Path]:
    files = importlib.metadata.files("example-robot-data") or []
    return {file.name: Path(file.locate()) for file in files if file.suffix == ".urdf"}


def _serial_arm(path: Path, tool: str) -> Arm:
    full = pin.buildModelFromUrdf(str(path))
    links = [frame.name for frame in full.frames if frame.type == pin.FrameType.BODY]
    if tool not in links:
        raise UnknownName(f"tool link of {path.name}", tool, links)
    moving = set(full.supports[full.frames[tool_frame(full, tool)].parentJoint])
    locked = [joint for joint in range(1, full.njoints) if joint not in moving]
    model = pin.buildReducedModel(full, locked, pin.neutral(full))
    if (model.njoints - 1, model.nq, model.nv) != (JOINTS,) * 3:
        raise UnsuitableRobot(
            f"{path.name} moves {tool!r} with {model.njoints - 1} joints, {model.nq} coordinates and {model.nv} degrees"
            f" of freedom; valid: an arm of {JOINTS} bounded one-axis joints"
        )
    return Arm(model, tool)


def load_robot(name: str, entries: Mapping[str, Mapping]) -> Robot:
    """The robot `name` as its entry in the configuration's `robots` describes it.

    Raises UnknownName (robot, URDF, tool frame, joint), UnsuitableRobot, InvalidSetting (home beyond a joint limit).
    """
    if name not in entries:
        raise UnknownName("robot", name, entries)
    entry = entries[name]
    if entry["urdf"] not in _urdf_files():
        raise UnknownName("URDF of example-robot-data", entry["urdf"], _urdf_files())
    path = _urdf_files()[entry["urdf"]]
    arm = _serial_arm(path, entry["tool"])
    joints = tuple(arm.model.names)[1:]
    for key in ("home", "limits"):
        for joint in entry.get(key, {}):
            if joint not in joints:
                raise UnknownName(f"joint in robots.{name}.{key}", joint, joints)
    missing = [joint for joint in joints if joint not in entry["home"]]
    if missing:
        raise InvalidSetting(
            f"robots.{name}.home", entry["home"], f"an angle for {', '.join(missing)} too"
        )
    home = np.array([quantities.angle(entry["home"][joint]) for joint in joints])
    lower, upper = arm.model.lowerPositionLimit.copy(), arm.model.upperPositionLimit.copy()
    for joint, (low, high) in entry.get("limits", {}).items():
        index = joints.index(joint)
        lower[index], upper[index] = quantities.angle(low), quantities.angle(high)
    for joint, q, low, high in zip(joints, home, lower, upper, strict=True):
        if not low <= q <= high:
            valid = f"{math.degrees(low):.1f} deg to {math.degrees(high):.1f} deg"
            raise InvalidSetting(f"robots.{name}.home.{joint}", entry["home"][joint], valid)
    size = [quantities.length(side) for side in entry["workspace"]["position"]]
    size += [quantities.angle(side) for side in entry["workspace"]["orientation"]]
    for side, given in zip(
        size, [*entry["workspace"]["position"], *entry["workspace"]["orientation"]], strict=True
    ):
        if side <= 0:
            raise InvalidSetting(f"robots.{name}.workspace", given, "sides above zero")
    workspace = Workspace(centre=arm.forward(home[None])[0], half_ranges=np.array(size) / 2)
    return Robot(name, path, arm, home, lower, upper, workspace)
