"""How widths and learning rates fall during training: the laws, and from where to where.

Each law takes the value at the start, the value at the end and the fraction of the training that
is done, in [0, 1]; they broadcast.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from recalib.errors import InvalidSetting

DIMENSIONS = 3  # of each net's centres: positions for a supernet, orientations for a subnet

# What is spread evenly by `equal_visits`, and what it adds to the power of the width.
SPREADS = {"widths": 1, "logarithms": 0}


def exponential(start: np.ndarray, end: np.ndarray, fraction: float) -> np.ndarray:
    """The same factor in every iteration: Ritter's decay of widths and rates."""
    return start * (end / start) ** fraction


def linear(start: np.ndarray, end: np.ndarray, fraction: float) -> np.ndarray:
    """The same step in every iteration: how the improved system's rate falls (section 7)."""
    return start + (end - start) * fraction


def equal_visits(
    start: np.ndarray,
    end: np.ndarray,
    fraction: float,
    dimensions: int = DIMENSIONS,
    spread: str = "widths",
) -> np.ndarray:
    """The same mean number of visits of a cell at every width (section 6).

    The time spent at a width s is inversely proportional to the expected learning L of (10), which
    grows as s^n. With as many visits in every step of the width, dt is proportional to s^-n ds, and
    s^(1-n) grows linearly in time; with as many in every step of its logarithm, dt is proportional
    to s^-n ds/s, and s^-n does.

    Args:
        dimensions: n, at least 2.
        spread: widths or logarithms.
    """
    power = SPREADS[spread] - dimensions
    return linear(np.power(start, power), np.power(end, power), fraction) ** (1 / power)


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


RATES = {"linear": linear, "exponential": exponential}


@dataclass(frozen=True)
class Schedule:
    """Widths and rates at the start and at the end of training, each a number or an array (run,).

    Args:
        initial_width: of all neighbourhoods (section 7), in workspace coordinates: the workspace
            is 2 wide.
        final_widths: for each map (`Rules.maps`), those of g_k and of g_kl.
        initial_rate, final_rate: the learning rate c' of (4), (5), (7) and (9).

    Raises InvalidSetting where a width is not above 0 or a rate not in (0, 1].
    """

    initial_width: float | np.ndarray
    final_widths: Mapping[str, Sequence[float | np.ndarray] | np.ndarray]
    initial_rate: float | np.ndarray
    final_rate: float | np.ndarray

    def __post_init__(self) -> None:
        for width in (self.initial_width, *chain.from_iterable(self.final_widths.values())):
            if not np.all(np.greater(width, 0)):
                raise InvalidSetting("width of a neighbourhood", width, "above 0")
        for rate in (self.initial_rate, self.final_rate):
            if not np.all(np.greater(rate, 0) & np.less_equal(rate, 1)):
                raise InvalidSetting("learning rate", rate, "above 0 and at most 1")

    def over(self, runs: int) -> "Schedule":
        """The same for so many runs, all arrays (run,)."""
        return self._each(lambda number: np.full(runs, number))

    def of_run(self, run: int) -> "Schedule":
        """That of one of several runs, all numbers."""
        return self._each(lambda numbers: float(np.asarray(numbers)[run]))

    def _each(self, change: Callable[[Any], Any]) -> "Schedule":
        widths = {name: [*map(change, pair)] for name, pair in self.final_widths.items()}
        rates = change(self.initial_rate), change(self.final_rate)
        return Schedule(change(self.initial_width), widths, *rates)

    @classmethod
    def of_runs(cls, schedules: Sequence["Schedule"]) -> "Schedule":
        """One for several runs, from that of each."""
        first = schedules[0]
        return cls(
            np.array([schedule.initial_width for schedule in schedules]),
            {
                name: np.array([schedule.final_widths[name] for schedule in schedules]).T
                for name in first.final_widths
            },
            np.array([schedule.initial_rate for schedule in schedules]),
            np.array([schedule.final_rate for schedule in schedules]),
        )
