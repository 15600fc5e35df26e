"""How widths and learning rates fall during training: one law, and from where to where.

Some power p of what falls is linear in time: `fall(start, end, fraction, p)`. For p = 1, the same
step in every iteration; in the limit p = 0, the same factor, Ritter's exponential decay. For the
same mean number of visits of a cell at every width (section 6), the time spent at a width s is
inversely proportional to the expected learning L of (10), which grows as s^n. With as many visits
in every step of the width, dt is proportional to s^-n ds, and p = 1 - n; with as many in every step
of its logarithm, dt is proportional to s^-n ds/s, and p = -n.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_kind, check_runs
from recalib.learners.kernels import fall as fall

EXPONENTIAL, LINEAR = 0.0, 1.0  # powers
RATES = {"linear": LINEAR, "exponential": EXPONENTIAL}
DIMENSIONS = 3  # of each net's centres: positions for a supernet, orientations for a subnet
SPREADS = {"widths": 1, "logarithms": 0}  # what equal visits are spread over, and its power


def equal_visits(dimensions: int = DIMENSIONS, spread: str = "widths") -> float:
    """The power for the same mean number of visits at every width (section 6).

    Args:
        dimensions: n of (10), at least 2.
        spread: what visits are spread over evenly, of `SPREADS`.
    """
    return float(SPREADS[spread] - dimensions)


def expected_learning(
    width: float | np.ndarray, dimensions: int, volume: float
) -> float | np.ndarray:
    """L of (10): what a cell far from the border learns in one iteration, on average.

    Args:
        width: of the Gaussians.
        dimensions: of the space in which the winners lie.
        volume: of the workspace there.
    """
    return np.power(width, dimensions) * (2 * np.pi) ** (dimensions / 2) / volume


Width = float | np.ndarray
Widths = Mapping[str, Sequence[Width] | np.ndarray]  # of g_k and of g_kl of each map


@dataclass(frozen=True)
class Schedule:
    """Widths and rates at the start and at the end of training, each a number or an array (run,).

    Args:
        initial_width: of all neighbourhoods (section 7), in workspace coordinates: the workspace
            is 2 wide. Or a width for each.
        final_widths: for each map (`Rules.maps`), the final widths of g_k and of g_kl.
        initial_rate, final_rate: the learning rate c' of (4), (5), (7) and (9).

    Raises InvalidSetting if a width is not positive or a rate is not in (0, 1], and for anything
    but such numbers.
    """

    initial_width: Width | Widths
    final_widths: Widths
    initial_rate: float | np.ndarray
    final_rate: float | np.ndarray

    def __post_init__(self) -> None:
        check_kind("final_widths", self.final_widths, Mapping)
        for key in ("initial_width", "final_widths"):
            widths = getattr(self, key)
            for pair in widths.values() if isinstance(widths, Mapping) else ():
                if not isinstance(pair, Sequence | np.ndarray) or len(pair) != 2:
                    raise InvalidSetting(key, pair, "two for each map, of g_k and of g_kl")
            _each(partial(_check, key, np.inf, "above 0"), widths)
        for key in ("initial_rate", "final_rate"):
            _check(key, 1.0, "above 0 and at most 1", getattr(self, key))

    def over(self, runs: int) -> "Schedule":
        """The same for a number of runs, all arrays (run,).

        Raises InvalidSetting: no number, or an array of other runs.
        """
        check_runs(runs)

        def full(number: float | np.ndarray) -> np.ndarray:
            if np.size(number) not in (1, runs):
                raise InvalidSetting("schedule", f"of {np.size(number)} runs", f"of 1 or {runs}")
            return np.full(runs, number)

        return self._of(full, self)

    def widths(self, maps: Collection[str]) -> tuple[np.ndarray, np.ndarray]:
        """Initial and final widths (run, map, 2) of the schedule of several runs.

        Raises InvalidSetting where it is for other maps.
        """
        if {*maps} != {*self.final_widths}:
            raise InvalidSetting("final_widths", [*self.final_widths], f"widths for {[*maps]}")
        final = np.array([[*map(np.asarray, self.final_widths[name])] for name in maps])
        if isinstance(self.initial_width, Mapping):
            initial = np.array([[*map(np.asarray, self.initial_width[name])] for name in maps])
        else:
            initial = np.broadcast_to(self.initial_width, final.shape)
        first, last = (np.ascontiguousarray(part.transpose(2, 0, 1)) for part in (initial, final))
        return first, last

    def of_run(self, run: int) -> "Schedule":
        """The schedule of one run, all numbers."""
        return self._of(lambda numbers: float(np.asarray(numbers)[run]), self)

    @classmethod
    def of_runs(cls, schedules: Sequence["Schedule"]) -> "Schedule":
        """A schedule for several runs, from one for each."""
        return cls._of(lambda *numbers: np.array(numbers), *schedules)

    @classmethod
    def _of(cls, change: Callable[..., Any], *schedules: "Schedule") -> "Schedule":
        """The schedule with what `change` makes of the numbers of others, place by place."""
        parts = zip(*(vars(schedule).values() for schedule in schedules), strict=True)
        return cls(*(_each(change, *part) for part in parts))


def _check(key: str, most: float, valid: str, given: float | np.ndarray) -> None:
    """Raise InvalidSetting unless numbers () or (run,) are above 0, and none is above the most."""
    numbers = array_of(key, given, (), ("run",))
    if not np.all((numbers > 0) & (numbers <= most)):
        raise InvalidSetting(key, given, valid)


def _each(change: Callable[..., Any], *parts: Any) -> Any:
    """What a change makes of numbers, or of those at each place of pairs by map."""
    if not isinstance(parts[0], Mapping):
        return change(*parts)
    pairs = {name: zip(*(part[name] for part in parts), strict=True) for name in parts[0]}
    return {name: [change(*numbers) for numbers in pair] for name, pair in pairs.items()}
