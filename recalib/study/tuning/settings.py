"""Widths and rates of a learner: as a row of numbers, and as a point that a search moves.

The numbers of a row are named by `columns`. A point lies in [0, 1]^d; its coordinates are
logarithmic. A neighbourhood may be as narrow as the winner alone, and as wide as flat; its final
width lies between the narrowest and the initial one. So a coordinate of 0 is the winner alone, and
one of 1 a width that does not fall. Rates go likewise.
"""

from collections.abc import Sequence

import numpy as np

from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule
from recalib.study.configuration.study import Ranges

DIGITS = 4  # of the numbers tried, so that the files that keep them are exact


def columns(rules: Rules) -> list[str]:
    """The names of a row's numbers."""
    widths = [f"{name}_{net}" for name in rules.maps for net in ("g_k", "g_kl")]
    return ["initial_width", *widths, "initial_rate", "final_rate"]


def rows(points: np.ndarray, ranges: Ranges) -> np.ndarray:
    """The rows (n, d) of points (n, d)."""
    (narrowest, flat), (slowest, fastest) = np.log(ranges.widths), np.log(ranges.rates)
    logs = np.empty_like(points)
    for first, finals, (low, high) in (
        (0, slice(1, -2), (narrowest, flat)),
        (-2, slice(-1, None), (slowest, fastest)),
    ):
        logs[:, first] = low + points[:, first] * (high - low)
        logs[:, finals] = low + points[:, finals] * (logs[:, [first]] - low)
    return np.array([[float(f"{value:.{DIGITS}g}") for value in row] for row in np.exp(logs)])


def point(row: np.ndarray, ranges: Ranges) -> np.ndarray:
    """The point (d,) of a row (d,), up to rounding."""
    (narrowest, flat), (slowest, fastest) = np.log(ranges.widths), np.log(ranges.rates)
    logs, found = np.log(row), np.empty(len(row))
    for first, finals, (low, high) in (
        (0, slice(1, -2), (narrowest, flat)),
        (-2, slice(-1, None), (slowest, fastest)),
    ):
        found[first] = (logs[first] - low) / (high - low)
        width = logs[first] - low
        found[finals] = (logs[finals] - low) / width if width > 0 else 1.0
    return np.clip(found, 0, 1)


def schedule(settings: np.ndarray, rules: Rules) -> Schedule:
    """The schedule of runs with these rows (run, d)."""
    initial, *widths, rate, final = np.ascontiguousarray(np.transpose(settings))
    pairs: Sequence[list[np.ndarray]] = [widths[i : i + 2] for i in range(0, len(widths), 2)]
    return Schedule(initial, dict(zip(rules.maps, pairs, strict=True)), rate, final)
