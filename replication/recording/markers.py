"""Where an arm is damaged: which links, which joints, and how its base was moved."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from recalib.damaged.damage import BaseShift, Damage, apply
from recalib.nominal.robots import Robot
from replication.config.damages import Entry

HALF_AXIS = 0.5  # of the axis that is drawn through a joint, in units of `Scene.unit`


@dataclass(frozen=True)
class Marker:
    """A damaged link or joint.

    Attributes:
        part: its name.
        link: the link itself, or the one that the joint moves.
        axis: (2, 3) m in the frame of that link, of the joint; None where the link is damaged.
    """

    part: str
    link: str
    axis: np.ndarray | None


def link_of(entry: Entry) -> str:
    """The link that a damage is at; empty if it is at none."""
    return getattr(entry, "link", "")


def joint_of(entry: Entry) -> str:
    """The joint that a damage is at; empty if it is at none."""
    return getattr(entry, "joint", "") or getattr(entry, "encoder", "")


def markers(robot: Robot, damages: Iterable[Damage], unit: float) -> list[Marker]:
    """The markers of damages on the arm that has them: one for each link and joint.

    Args:
        unit: m, by which they are sized.
    """
    moved = {number: link for link, number in robot.links.items()}
    found: dict[str, Marker] = {}
    for damage in damages:
        if link := link_of(damage):
            found[link] = Marker(link, link, None)
        elif joint := joint_of(damage):
            index = robot.joints.index(joint)
            reach = HALF_AXIS * unit * robot.arm.axes[index]
            found[joint] = Marker(joint, moved[1 + index], np.stack([-reach, reach]))
    return [*found.values()]


def base_shift(robot: Robot, damages: Iterable[Damage]) -> pin.SE3:
    """How the base of the damaged robot stands in the frame of the nominal one."""
    shifts = apply(robot, [damage for damage in damages if isinstance(damage, BaseShift)])
    first = robot.arm.model.jointPlacements[1]
    return shifts.arm.model.jointPlacements[1] * first.inverse()


def circle(placement: pin.SE3, radius: float) -> np.ndarray:
    """A circle (point, 3) [m] about the z axis of a placement."""
    angles = np.linspace(0, 2 * np.pi, 49)
    flat = radius * np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    return flat @ placement.rotation.T + placement.translation
