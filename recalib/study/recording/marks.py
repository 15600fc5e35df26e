"""What is wrong with an arm, marked where it is: which link is short, which joint is off."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from recalib.damaged.damage import BaseShift, Damage, LinkShortening, apply
from recalib.nominal.robots import Robot, link_end
from recalib.study.configuration.damages import describe

# in units of `scene.unit_of`
HALF_AXIS = 0.5  # of the axis that is drawn through a joint
NEAR = 0.6  # places whose words would lie upon one another


@dataclass(frozen=True)
class Mark:
    """A mark at a link, in its frame.

    Attributes:
        link: that has it.
        words: of it; empty where they stand at another one.
        at: (3,) m, where they stand.
        axis: (2, 3) m, of the joint that is off; None where it is the link itself.
    """

    link: str
    words: str
    at: np.ndarray
    axis: np.ndarray | None


def marks(robot: Robot, damages: Iterable[Damage], unit: float) -> list[Mark]:
    """The marks of damages on the arm that has them.

    Args:
        unit: m, by which they are sized.
    """
    moved = {joint: link for link, joint in robot.links.items()}
    of_links: dict[str, list[str]] = {}
    of_joints: dict[str, list[str]] = {}
    for damage in damages:
        match damage:
            case BaseShift():
                continue
            case LinkShortening():
                of_links.setdefault(damage.link, []).append(words(damage))
            case _:
                link = moved[1 + robot.joints.index(damage.joint)]
                of_joints.setdefault(link, []).append(words(damage))
    found = [
        *(_of_link(robot, link, "\n".join(each)) for link, each in of_links.items()),
        *(_of_joint(robot, link, "\n".join(each), unit) for link, each in of_joints.items()),
    ]
    return _gathered(robot, found, NEAR * unit)


def words(damage: Damage) -> str:
    """What is wrong, without where: the mark stands there."""
    (key, _), (_, amount), *_ = describe(damage).items()
    return f"{amount} short" if isinstance(damage, LinkShortening) else f"{key} {amount}"


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


def _gathered(robot: Robot, found: list[Mark], near: float) -> list[Mark]:
    """The marks, with the words of those so near [m] to one another at the last of them."""
    data = robot.arm.model.createData()
    pin.forwardKinematics(robot.arm.model, data, robot.home)
    places = [data.oMi[robot.links[mark.link]].act(mark.at) for mark in found]
    groups: list[list[int]] = []
    for number, place in enumerate(places):
        close = (its for its in groups if np.linalg.norm(place - places[its[-1]]) < near)
        its = next(close, None)
        if its is None:
            groups.append([number])
        else:
            its.append(number)
    gathered = list(found)
    for *others, last in (group for group in groups if len(group) > 1):
        lines = (
            f"{found[each].link.removesuffix('_link').replace('_', ' ')}: {line}"
            for each in (*others, last)
            for line in found[each].words.splitlines()
        )
        gathered[last] = replace(found[last], words="\n".join(lines))
        for each in others:
            gathered[each] = replace(found[each], words="")
    return gathered


def _of_link(robot: Robot, link: str, text: str) -> Mark:
    end = link_end(robot.arm.model, robot.arm.tool, robot.links[link])
    return Mark(link, text, end / 2, None)


def _of_joint(robot: Robot, link: str, text: str, unit: float) -> Mark:
    model, joint = robot.arm.model, robot.links[link]
    jacobian = pin.computeJointJacobian(model, model.createData(), robot.home, joint)
    reach = HALF_AXIS * unit * jacobian[3:, joint - 1]
    return Mark(link, text, reach, np.stack([-reach, reach]))
