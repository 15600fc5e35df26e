"""Links bent or twisted by a collision."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import Damage, DamagedArm, end_of
from recalib.damaged.imperfections import Link
from recalib.errors import InvalidSetting
from recalib.files.bounded import Direction, SignedTurn
from recalib.nominal.kinematics import Arm


@dataclass(frozen=True)
class LinkBend(Damage, words=("bend",)):
    """A link bent in the middle of the straight line between its joints."""

    link: Link
    bend: SignedTurn
    """Angle between the two halves of the line."""
    towards: Direction = 0.0
    """Direction of the bend: angle about the line, from the frame axis most nearly across it."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        end = end_of(arm, self.link, damaged)
        line = _line(end.translation, self.link)
        # rounding makes the choice between two equally good axes definite: the first
        across = np.eye(3)[np.abs(line).round(6).argmin()]
        side = np.cross(line, across) / np.linalg.norm(np.cross(line, across))
        axis = Rotation.from_rotvec(self.towards * line).apply(side)
        turn = Rotation.from_rotvec(self.bend * axis).as_matrix()
        half = end.translation / 2
        end.translation = half + turn @ half
        end.rotation = turn @ end.rotation


@dataclass(frozen=True)
class LinkTwist(Damage, words=("twist",)):
    """A link twisted about the straight line between its joints."""

    link: Link
    twist: SignedTurn
    """Angle by which the link's end is turned."""

    def apply(self, arm: Arm, damaged: DamagedArm) -> None:
        end = end_of(arm, self.link, damaged)
        line = _line(end.translation, self.link)
        end.rotation = Rotation.from_rotvec(self.twist * line).as_matrix() @ end.rotation


def _line(end: np.ndarray, link: str) -> np.ndarray:
    """Unit vector (3,) along a link. Raises InvalidSetting if the link has no length."""
    length = np.linalg.norm(end)
    if length < 1e-9:
        raise InvalidSetting("link", link, "a link with a length")
    return end / length
