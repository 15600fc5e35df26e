"""The rough search for widths and rates: quasi-random trials, as many for every training.

A trial is a row of numbers: initial_width, for each map and net a final width (such as
`position/g_k`), initial_rate and final_rate. The first round of trials covers the ranges, later
ones a third of each range around the best so far. Every range is logarithmic; final values are
drawn as fractions of initial ones.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule

if TYPE_CHECKING:
    import pandas as pd

    from recalib.study.configuration.study import Budget

NETS = ("g_k", "g_kl")
ZOOM = 1 / 3
DIGITS = 4  # of the numbers tried, so that the files that keep them are exact


def columns(rules: Rules) -> list[str]:
    """The numbers of a trial."""
    return [
        "initial_width",
        *(f"{name}/{net}" for name in rules.maps for net in NETS),
        "initial_rate",
        "final_rate",
    ]


def draw(
    rules: Rules,
    ranges: Mapping,
    count: int,
    random: np.random.Generator,
    around: Mapping | None = None,
) -> "pd.DataFrame":
    """Trials, a row each.

    Args:
        ranges: for each kind of number, the lowest and the highest value.
        count: how many, best a power of two.
        random: of the quasi-random sequence.
        around: a trial; the box searched is then ZOOM as wide, about it, and inside the ranges.
    """
    import pandas as pd  # half a second each, which every training would pay
    from scipy.stats import qmc

    own = [ranges.get(column, ranges["final_width"]) for column in columns(rules)]
    low, high = np.log(np.array(own)).T
    unit = qmc.Sobol(len(low), rng=random).random(count)
    if around is not None:
        values = np.log([around[column] for column in columns(rules)])
        values[1:-2] -= values[0]
        values[-1] -= values[-2]
        centre = np.divide(values - low, high - low, out=np.zeros_like(low), where=high > low)
        unit = np.clip(centre - ZOOM / 2, 0, 1 - ZOOM) + ZOOM * unit
    values = low + unit * (high - low)
    values[:, 1:-2] += values[:, :1]
    values[:, -1] += values[:, -2]
    rounded = [[float(f"{value:.{DIGITS}g}") for value in row] for row in np.exp(values)]
    return pd.DataFrame(rounded, columns=columns(rules))


def schedule(trials: Mapping, rules: Rules, repeat: int = 1) -> Schedule:
    """The schedule of a trial, or of a frame of them: for runs in the order (trial, repetition)."""

    def column(name: str):
        values = np.asarray(trials[name], dtype=float)
        return np.repeat(values, repeat) if values.ndim else float(values)

    final = {name: tuple(column(f"{name}/{net}") for net in NETS) for name in rules.maps}
    return Schedule(column("initial_width"), final, column("initial_rate"), column("final_rate"))


SCORES: Mapping[str, Callable] = {
    "worse": np.maximum,
    "geometric_mean": lambda first, second: np.sqrt(first * second),
}


def scores(trials: Mapping, budget: "Budget") -> "pd.Series":
    """What the search minimises, of trials with their errors: the part left of the initial ones."""
    return SCORES[budget.score](
        trials["position_error_cm"] / budget.initial.position_error_cm,
        trials["orientation_error_deg"] / budget.initial.orientation_error_deg,
    )
