"""Links that a collision bends or twists."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import Damage, DamagedArm, end_of
from recalib.errors import InvalidSetting
from recalib.files.bounded import SignedTurn
from recalib.nominal.robots import Robot


@dataclass(frozen=True)
class LinkBend(Damage, words=("bend",)):
    """A link bent in the middle of the straight line between its joints."""

    link: str
    """A link of the robot."""
    bend: SignedTurn
    """Angle between the line's halves."""
    towards: SignedTurn = 0.0
    """Direction about the line in which the outer half goes; 0 is nearest to an axis of the frame."""

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        end = end_of(robot, self.link, damaged)
        line = _line(end.translation, self.link)
        # the axis of the frame that is most across the line, made perpendicular to it
        across = np.eye(3)[np.abs(line).argmin()]
        side = np.cross(line, across) / np.linalg.norm(np.cross(line, across))
        axis = Rotation.from_rotvec(self.towards * line).apply(side)
        turn = Rotation.from_rotvec(self.bend * axis).as_matrix()
        half = end.translation / 2
        end.translation = half + turn @ half
        end.rotation = turn @ end.rotation


@dataclass(frozen=True)
class LinkTwist(Damage, words=("twist",)):
    """A link twisted about the straight line between its joints."""

    link: str
    """A link of the robot."""
    twist: SignedTurn
    """Angle by which its end is turned."""

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        end = end_of(robot, self.link, damaged)
        line = _line(end.translation, self.link)
        end.rotation = Rotation.from_rotvec(self.twist * line).as_matrix() @ end.rotation


def _line(end: np.ndarray, link: str) -> np.ndarray:
    """The direction (3,) of a link. Raises InvalidSetting: it has no length."""
    length = np.linalg.norm(end)
    if length < 1e-9:
        raise InvalidSetting("link", link, "a link with a length")
    direction: np.ndarray = end / length
    return direction
