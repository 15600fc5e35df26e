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
class Marker:
    """A marker at a link, in its frame.

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


def markers(robot: Robot, damages: Iterable[Damage], unit: float) -> list[Marker]:
    """The markers of damages on the arm that has them, those of links first.

    Args:
        unit: m, by which they are sized.
    """
    moved = {joint: link for link, joint in robot.links.items()}
    of_links: dict[str, list[str]] = {}
    of_joints: dict[str, list[str]] = {}
    for damage in damages:
        if isinstance(damage, LinkShortening):
            of_links.setdefault(damage.link, []).append(words(damage))
        elif not isinstance(damage, BaseShift):
            link = moved[1 + robot.joints.index(damage.joint)]
            of_joints.setdefault(link, []).append(words(damage))
    found = [_of_link(robot, link, "\n".join(lines)) for link, lines in of_links.items()]
    found += [_of_joint(robot, link, "\n".join(lines), unit) for link, lines in of_joints.items()]
    return _gathered(robot, found, NEAR * unit)


def words(damage: Damage) -> str:
    """What is wrong, without where: the marker stands there."""
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


def _gathered(robot: Robot, found: list[Marker], radius: float) -> list[Marker]:
    """The markers; of those within a radius [m] of one another, the last has all words."""
    data = robot.arm.model.createData()
    pin.forwardKinematics(robot.arm.model, data, robot.home)
    places = [data.oMi[robot.links[marker.link]].act(marker.at) for marker in found]
    groups: list[list[int]] = []
    for number, place in enumerate(places):
        for group in groups:
            if np.linalg.norm(place - places[group[-1]]) < radius:
                group.append(number)
                break
        else:
            groups.append([number])
    gathered = [replace(marker, words="") for marker in found]
    for group in groups:
        lines = found[group[-1]].words
        if len(group) > 1:
            lines = "\n".join(line for number in group for line in _named(found[number]))
        gathered[group[-1]] = replace(found[group[-1]], words=lines)
    return gathered


def _named(marker: Marker) -> list[str]:
    """Its words, each with its link."""
    link = marker.link.removesuffix("_link").replace("_", " ")
    return [f"{link}: {line}" for line in marker.words.splitlines()]


def _of_link(robot: Robot, link: str, text: str) -> Marker:
    end = link_end(robot.arm.model, robot.arm.tool, robot.links[link])
    return Marker(link, text, end / 2, None)


def _of_joint(robot: Robot, link: str, text: str, unit: float) -> Marker:
    model, joint = robot.arm.model, robot.links[link]
    jacobian = pin.computeJointJacobian(model, model.createData(), robot.home, joint)
    reach = HALF_AXIS * unit * jacobian[3:, joint - 1]
    return Marker(link, text, reach, np.stack([-reach, reach]))
