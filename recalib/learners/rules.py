"""What tells a learner of the paper from another: four switches, and the sizes of the nets.

The improvement of the paper is four changes of Ritter's algorithm. Each is a switch of its own
here, so that any of them can be taken away from the one or added to the other.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from recalib.nominal.poses import ORIENTATION, POSITION

SEPARATE = {"position": POSITION, "orientation": ORIENTATION}
SINGLE = {"pose": slice(0, 6)}


@dataclass(frozen=True)
class Rules:
    """The four switches and the sizes of the nets.

    Args:
        separate_maps: one map for position and one for orientation commands (section 4), or one
            for both.
        theta_increments: propagate increments of theta, (6) and (7), or its values, (2) and (4).
        jacobian_increments: propagate increments of the Jacobian, (8) and (9), or its values, (3)
            and (5).
        equal_visits: the schedule of section 6 with a linear rate, or Ritter's exponential
            schedules.
        supernet, subnet: cells along each position and each orientation coordinate.
    """

    separate_maps: bool
    theta_increments: bool
    jacobian_increments: bool
    equal_visits: bool
    supernet: tuple[int, int, int] = (3, 3, 3)
    subnet: tuple[int, int, int] = (3, 3, 3)

    @property
    def maps(self) -> Mapping[str, slice]:
        """Name of each map and the coordinates of the command that it computes."""
        return SEPARATE if self.separate_maps else SINGLE


IMPROVED = Rules(
    separate_maps=True, theta_increments=True, jacobian_increments=True, equal_visits=True
)
