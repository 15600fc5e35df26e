"""A kind of damage that the project does not know: a link that became longer."""

from dataclasses import dataclass

import numpy as np

from recalib import DamagedArm, Robot
from recalib.damaged import Damage, Link, end_of
from recalib.files import Amount


@dataclass(frozen=True)
class LinkStretch(Damage, words=("stretch",)):
    """A link stretched along the line between its joints."""

    link: Link
    stretch: Amount
    """Length added."""

    def apply(self, robot: Robot, damaged: DamagedArm) -> None:
        end = end_of(robot, self.link, damaged).translation
        end *= 1 + self.stretch / np.linalg.norm(end)
