"""The fall of widths and learning rates during training: one law, with start and end values.

A power p of the quantity is linear in time: `fall(start, end, fraction, p)`. For p = 1, every
iteration subtracts the same step; in the limit p = 0, it multiplies by the same factor, which is
Ritter's exponential decay. For the same mean number of visits of a cell at every width (section 6),
the time spent at a width s is inversely proportional to the expected learning L of (10), which
grows as s^n. For equal visits in equal steps of the width, dt is proportional to s^-n ds, and
p = 1 - n; for equal visits in equal steps of its logarithm, dt is proportional to s^-n ds/s, and
p = -n.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_kind, check_runs
from recalib.learners.cell_loops import fall as fall

EXPONENTIAL, LINEAR = 0.0, 1.0  # powers
RATES = {"linear": LINEAR, "exponential": EXPONENTIAL}
DIMENSIONS = 3  # of each net's centres: positions for a supernet, orientations for a subnet
SPREADS = {"widths": 1, "logarithms": 0}  # the variable with equal visits, and its term in p


def equal_visits(dimensions: int = DIMENSIONS, spread: str = "widths") -> float:
    """The power for the same mean number of visits at every width (section 6).

    Args:
        dimensions: n in (10), at least 2.
        spread: the variable with equal visits, one of `SPREADS`.
    """
    return float(SPREADS[spread] - dimensions)


def expected_learning(
    width: float | np.ndarray, dimensions: int, volume: float
) -> float | np.ndarray:
    """L in (10): the expected learning of a cell far from the border in one iteration.

    Args:
        width: width of the Gaussians.
        dimensions: dimensions of the space in which the winners lie.
        volume: volume of the workspace in this space.
    """
    return np.power(width, dimensions) * (2 * np.pi) ** (dimensions / 2) / volume


Width = float | np.ndarray
Widths = Mapping[str, Sequence[Width] | np.ndarray]  # of g_k and of g_kl of each map


@dataclass(frozen=True)
class Schedule:
    """Widths and rates at the start and at the end of training, each a number or an array (run,).

    Args:
        initial_width: one width of all neighbourhoods (section 7), in workspace coordinates (the
            workspace is 2 wide), or a width for each.
        final_widths: for each map (`Rules.maps`), the final widths of g_k and of g_kl.
        initial_rate, final_rate: the learning rate c' in (4), (5), (7) and (9).

    Raises InvalidSetting if a width is not positive, a rate is not in (0, 1], or a value is not a
    number or an array (run,).
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
        """The same schedule for a number of runs; all values are arrays (run,).

        Raises InvalidSetting for an invalid number of runs, or arrays of another length.
        """
        check_runs(runs)

        def full(number: float | np.ndarray) -> np.ndarray:
            if np.size(number) not in (1, runs):
                raise InvalidSetting("schedule", f"of {np.size(number)} runs", f"of 1 or {runs}")
            return np.full(runs, number)

        return self._of(full, self)

    def widths(self, maps: Collection[str]) -> tuple[np.ndarray, np.ndarray]:
        """Initial and final widths (run, map, 2) of a schedule for several runs.

        Raises InvalidSetting if it is for other maps.
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
        """The schedule of one run; all values are numbers."""
        return self._of(lambda numbers: float(np.asarray(numbers)[run]), self)

    @classmethod
    def of_runs(cls, schedules: Sequence["Schedule"]) -> "Schedule":
        """One schedule for several runs, from a schedule for each run."""
        return cls._of(lambda *numbers: np.array(numbers), *schedules)

    @classmethod
    def _of(cls, change: Callable[..., Any], *schedules: "Schedule") -> "Schedule":
        """The schedule with the results of `change` for corresponding numbers of the schedules."""
        parts = zip(*(vars(schedule).values() for schedule in schedules), strict=True)
        return cls(*(_each(change, *part) for part in parts))


def _check(key: str, most: float, valid: str, given: float | np.ndarray) -> None:
    """Raise InvalidSetting unless numbers () or (run,) are above 0 and at most `most`."""
    numbers = array_of(key, given, (), ("run",))
    if not np.all((numbers > 0) & (numbers <= most)):
        raise InvalidSetting(key, given, valid)


def _each(change: Callable[..., Any], *parts: Any) -> Any:
    """The results of `change` for numbers, or for corresponding numbers in pairs by map."""
    if not isinstance(parts[0], Mapping):
        return change(*parts)
    pairs = {name: zip(*(part[name] for part in parts), strict=True) for name in parts[0]}
    return {name: [change(*numbers) for numbers in pair] for name, pair in pairs.items()}
