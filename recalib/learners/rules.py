"""The options of the paper's learners: switches, sizes, conventions.

The paper improves Ritter's algorithm by four changes. Each change is a switch here, so it can be
removed from the improved algorithm or added to Ritter's.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_kind, check_name
from recalib.learners.nets import CENTRES
from recalib.learners.schedules import DIMENSIONS, EXPONENTIAL, RATES, SPREADS, equal_visits
from recalib.nominal.workspace import ORIENTATION, POSITION

SEPARATE = {"position": POSITION, "orientation": ORIENTATION}
SINGLE = {"pose": slice(0, 6)}


@dataclass(frozen=True)
class Rules:
    """The four switches, the sizes of the nets, and the conventions that the paper leaves open.

    Args:
        separate_maps: one map for position and one for orientation commands (section 4), or one
            for both.
        theta_increments: propagate increments of theta, (6) and (7), or its values, (2) and (4).
        jacobian_increments: propagate increments of the Jacobian, (8) and (9), or its values, (3)
            and (5).
        equal_visits: widths fall by the schedule of section 6, or by Ritter's exponential schedule.
        supernet, subnet: cells along each position and each orientation coordinate.
        centres: centres of the cells: in the middle of equal "boxes", or from face to face
            ("faces") of the workspace (section 3).
        metric: six factors that convert workspace coordinates into the units of the norm in (3) and
            (8); only their ratios matter. If all are 1, the units are half-ranges of the workspace;
            if they are the half-ranges in m and rad, the units are metres and radians.
        width_units: six factors that convert workspace coordinates into units of widths, in which
            distances between centres are measured. If all are 1: half-ranges of the workspace.
        dimensions: n in (10), for equal visits: 3 (of each net) or 6 (of both together).
        spread: visits are equal for equal steps of "widths", or of their "logarithms".
        rate: law of the learning rate, "linear" (section 7) or "exponential" (Ritter); None:
            linear with equal visits, exponential without.
        initial: None: theta starts as the identity. A seed: if values of theta are propagated, each
            cell's theta is drawn uniformly from the workspace, the same for all runs. Increments
            never replace the start, so with increments theta always starts as the identity.

    Raises UnknownName and InvalidSetting.
    """

    separate_maps: bool
    theta_increments: bool
    jacobian_increments: bool
    equal_visits: bool
    supernet: tuple[int, int, int] = (3, 3, 3)
    subnet: tuple[int, int, int] = (3, 3, 3)
    centres: str = "boxes"
    metric: tuple[float, ...] = (1.0,) * 6
    dimensions: int = DIMENSIONS
    spread: str = "widths"
    rate: str | None = None
    width_units: tuple[float, ...] = (1.0,) * 6
    initial: int | None = None

    def __post_init__(self) -> None:
        for key in ("separate_maps", "theta_increments", "jacobian_increments", "equal_visits"):
            check_kind(key, getattr(self, key), bool)
        check_name("centres of cells", self.centres, CENTRES)
        check_name("spread of equal visits", self.spread, SPREADS)
        check_kind("rate", self.rate, str, type(None))
        check_name("fall of the learning rate", self.law_of_rate, RATES)
        check_kind("dimensions", self.dimensions, int)
        if self.dimensions not in (3, 6):
            raise InvalidSetting("dimensions", self.dimensions, "3 or 6")
        for key in ("supernet", "subnet"):
            cells = array_of(key, getattr(self, key), (3,))
            if not (np.greater(cells, 0) & (cells == np.round(cells))).all():
                raise InvalidSetting(key, getattr(self, key), "three whole numbers, at least 1")
        for key in ("metric", "width_units"):
            factors = getattr(self, key)
            if np.shape(factors) != (6,) or not np.all(np.greater(factors, 0)):
                raise InvalidSetting(key, factors, "six numbers above 0")

    @property
    def maps(self) -> Mapping[str, slice]:
        """Name of each map and the coordinates of the command that it computes."""
        return SEPARATE if self.separate_maps else SINGLE

    @property
    def law_of_rate(self) -> str:
        """The law of the learning rate: `rate`, or by default the law that matches the widths."""
        return self.rate or ("linear" if self.equal_visits else "exponential")

    @property
    def width_power(self) -> float:
        """The power of the width that is linear in time; see `recalib.learners.schedules`."""
        return equal_visits(self.dimensions, self.spread) if self.equal_visits else EXPONENTIAL

    @property
    def rate_power(self) -> float:
        """The power of the learning rate that is linear in time."""
        return RATES[self.law_of_rate]


IMPROVED = Rules(
    separate_maps=True, theta_increments=True, jacobian_increments=True, equal_visits=True
)
