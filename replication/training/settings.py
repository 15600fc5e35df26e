"""Widths and rates of a learner: as a row of numbers, and as a point that a search moves.

A point lies in [0, 1]^d; its coordinates are logarithmic. A neighbourhood may be as narrow as the
winner alone, and as wide as flat; its final width lies between the narrowest and the initial one.
So a coordinate of 0 is the winner alone, and one of 1 a width that does not fall. Rates go
likewise.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule
from replication.config.campaign import Ranges

DIGITS = 4  # of the numbers tried, so that the tables that keep them are exact
NETS = "g_k", "g_kl"
INITIAL, FIRST_RATE, LAST_RATE = "initial_width", "initial_rate", "final_rate"


@dataclass(frozen=True)
class Space:
    """The settings among which a search chooses.

    Attributes:
        rules: of the learner.
        ranges: of widths and rates.
        narrower: of two neighbourhoods of a map, the one whose final width is at most that of the
            other, such as {"position_g_k": "position_g_kl"}.
        constant: neighbourhoods whose width is given, and does not fall.
    """

    rules: Rules
    ranges: Ranges
    narrower: Mapping[str, str] = field(default_factory=dict)
    constant: Mapping[str, float] = field(default_factory=dict)

    @property
    def neighbourhoods(self) -> list[str]:
        """The columns of final widths."""
        return [f"{name}_{net}" for name in self.rules.maps for net in NETS]

    @property
    def columns(self) -> list[str]:
        """The names of a row's numbers."""
        return [INITIAL, *self.neighbourhoods, FIRST_RATE, LAST_RATE]

    @property
    def coordinates(self) -> list[str]:
        """The columns that are sought."""
        return [column for column in self.columns if column not in self.constant]

    def rows(self, points: np.ndarray) -> np.ndarray:
        """The rows (n, column) of points (n, coordinate)."""
        share = dict(zip(self.coordinates, points.T, strict=True))
        logs = dict[str, np.ndarray]()
        for column in self._in_order():
            low, high = self._bounds(column, logs)
            logs[column] = low + share[column] * (high - low)
        found = {name: np.exp(values) for name, values in logs.items()}
        found |= {name: np.full(len(points), width) for name, width in self.constant.items()}
        table = np.column_stack([found[column] for column in self.columns])
        return np.array([[float(f"{number:.{DIGITS}g}") for number in row] for row in table])

    def point(self, row: np.ndarray) -> np.ndarray:
        """The point (coordinate,) of a row (column,), or the nearest one."""
        given = dict(zip(self.columns, np.log(row), strict=True))
        logs, found = dict[str, np.ndarray](), dict[str, np.ndarray]()
        for column in self._in_order():
            low, high = self._bounds(column, logs)
            found[column] = np.clip((given[column] - low) / (high - low), 0, 1)
            logs[column] = low + found[column] * (high - low)
        return np.array([found[column] for column in self.coordinates])

    def schedule(self, rows: np.ndarray) -> Schedule:
        """The schedule of runs with these rows (run, column)."""
        its = dict(zip(self.columns, np.ascontiguousarray(rows.T), strict=True))
        starts = {name: its[name if name in self.constant else INITIAL] for name in its}

        def by_map(widths: Mapping[str, np.ndarray]) -> dict[str, list[np.ndarray]]:
            return {name: [widths[f"{name}_{net}"] for net in NETS] for name in self.rules.maps}

        initial = by_map(starts) if self.constant else its[INITIAL]
        return Schedule(initial, by_map(its), its[FIRST_RATE], its[LAST_RATE])

    def _in_order(self) -> list[str]:
        """The columns that are sought, each after that which bounds it."""
        return sorted(self.coordinates, key=lambda column: column in self.narrower)

    def _bounds(self, column: str, logs: Mapping[str, np.ndarray]) -> tuple[float, np.ndarray]:
        """Logarithms of the least and the largest value of a column, by those before it."""
        of_rate = column in (FIRST_RATE, LAST_RATE)
        low, high = np.log(self.ranges.rates if of_rate else self.ranges.widths)
        if column in (INITIAL, FIRST_RATE):
            return low, high
        above = FIRST_RATE if of_rate else self.narrower.get(column, INITIAL)
        # a width that may not fall has no room: anything is its share
        return low, np.maximum(logs[above], low + 1e-9)
