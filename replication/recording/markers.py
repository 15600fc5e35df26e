"""What is wrong with an arm, marked where it is: which link is short, which joint is off."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from recalib.damaged.damage import BaseShift, Damage, apply
from recalib.nominal.robots import Robot, link_end
from replication.recording.naming import amount, name, part_of

HALF_AXIS = 0.5  # of the axis that is drawn through a joint, in units of `scene.unit_of`


@dataclass(frozen=True)
class Marker:
    """A marker at a link, in its frame.

    Attributes:
        link: that has it.
        words: for its label.
        at: (3,) m, where the leader to its label starts.
        axis: (2, 3) m, of the joint that is off; None where it is the link itself.
    """

    link: str
    words: str
    at: np.ndarray
    axis: np.ndarray | None


def markers(robot: Robot, damages: Iterable[Damage], unit: float) -> list[Marker]:
    """The markers of damages on the arm that has them: one for each link and joint.

    Args:
        unit: m, by which they are sized.
    """
    moved = {joint: link for link, joint in robot.links.items()}
    of_links: dict[str, list[Damage]] = {}
    of_joints: dict[str, list[Damage]] = {}
    for damage in damages:
        if part := part_of(damage):
            its_kind = of_links if part in robot.links else of_joints
            its_kind.setdefault(part, []).append(damage)
    found = []
    for link, its in of_links.items():
        end = link_end(robot.arm.model, robot.arm.tool, robot.links[link]).translation
        found.append(Marker(link, _words(link, its), end / 2, None))
    for joint, its in of_joints.items():
        number = 1 + robot.joints.index(joint)
        reach = HALF_AXIS * unit * _axis(robot, number)
        axis = np.stack([-reach, reach])
        found.append(Marker(moved[number], _words(joint, its), reach, axis))
    return found


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


def _words(part: str, damages: Sequence[Damage]) -> str:
    """What is wrong with a link or joint."""
    return f"{name(part)}: {', '.join(map(amount, damages))}"


def _axis(robot: Robot, joint: int) -> np.ndarray:
    """Unit vector (3,) of a joint's axis in its frame."""
    model = robot.arm.model
    jacobian = pin.computeJointJacobian(model, model.createData(), robot.home, joint)
    return jacobian[3:, joint - 1]
