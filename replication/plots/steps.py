"""The figure of the factor: how many iterations each step from Ritter's map needs."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.campaign.variants import DOUBLE, TWO_MAPS
from replication.config.switches import IMPROVED, RITTER
from replication.judgement.contrasts import KEYS, SHARES, Crossing, Remaining, Values
from replication.judgement.evidence import Evidence
from replication.judgement.hierarchy import Model
from replication.plots.palette import BORDER, GREY, NEUTRAL, STYLES, Style
from replication.plots.style import MARK, WIDTH, logarithmic, name_rows, note, plt

PUBLISHED = 70
# By variant, from Ritter's map to the improved system. Colours of learners, whose names are here.
STEPS: Mapping[str, Style] = {
    RITTER: Style("#D3977E", "^", "-", "Ritter, half the cells"),
    DOUBLE: Style(STYLES[RITTER].color, "P", "-", "Ritter, as many cells"),
    TWO_MAPS: Style("#661100", "X", "-", "two maps"),
    "two_maps_jacobian": Style("#CD87AD", "v", "-", "+ Jacobian increments"),
    "two_maps_theta": Style("#05AB6E", "D", "-", "+ theta increments"),
    "two_maps_increments": Style("#61D6FF", "s", "-", "+ both increments"),
    IMPROVED: Style(STYLES[IMPROVED].color, "o", "-", "+ equal visits: improved"),
}
ENDS = 45, 45_000  # iterations


def steps(evidence: Evidence) -> Figure:
    """Below: iterations of each step for the improved system's errors; above: errors."""
    own, outcomes = evidence.study.experiments.iterations, evidence.outcomes()
    home, goal = outcomes[outcomes["setup"] == 0], Remaining(IMPROVED, own)
    figure, (above, below) = plt.subplots(
        2, 1, sharex=True, figsize=(WIDTH, 4.8), height_ratios=[1, 1.5]
    )
    _draw_errors(above, home, goal)
    texts = []
    for height, (variant, style) in zip(range(len(STEPS), 0, -1), STEPS.items(), strict=True):
        needed, bound = np.array([own]), 0
        if variant != IMPROVED:
            needed, bound = _needed(Crossing(variant, goal).values(home), own)
        middle = np.exp(np.log(needed).mean())
        below.hlines(height, own, middle, color=style.color, linewidth=3)
        below.scatter(needed, [height] * len(needed), s=MARK, zorder=3, **style.signs())
        texts.append(_in_words(middle, own, bound))
    setups = Crossing(DOUBLE, goal).values(outcomes)
    texts.append(_in_words(_draw_setups(below, setups, own), own))
    below.axhline(0.5, **BORDER)
    rows = range(len(STEPS), -1, -1)
    names = [style.label for style in STEPS.values()]
    name_rows(below, rows, [*names, f"as many cells,\n{len(setups.table)} setups"])
    beside = below.secondary_yaxis("right")
    beside.set_yticks(rows, texts)
    beside.tick_params(length=0)
    beside.spines["right"].set_visible(False)
    for axes in (above, below):
        axes.axvline(own * PUBLISHED, linestyle=(0, (4, 3)), **BORDER)
    note(
        above,
        f"the paper:\n{PUBLISHED}×",
        (own * PUBLISHED, 1),
        (3, 0),
        xycoords=("data", "axes fraction"),
        va="top",
        color=GREY,
    )
    below.set(xlim=ENDS, ylim=(-0.7, len(STEPS) + 0.6), xlabel="iterations, tuned for each number")
    logarithmic(below.xaxis, 50, 200, 1000, 5000, 20_000)
    return figure


def _draw_errors(axes: Axes, home: pd.DataFrame, goal: Remaining) -> None:
    """The larger share that remains of both errors, against the iterations of a training."""
    for variant, style in STEPS.items():
        rows = home[home["variant"] == variant]
        shares = np.log(100 * rows[SHARES].max(axis=1)).groupby(rows["iterations"]).mean()
        axes.plot(shares.index, np.exp(shares), markersize=3.5, color=style.color, marker=style.marker)
    level = 100 * np.exp(goal.values(home).table.to_numpy().mean())
    axes.axhline(level, color=STEPS[IMPROVED].color, linewidth=0.8)
    axes.set_ylabel("larger error that\nremains [%]")
    logarithmic(axes.yaxis, 1, 2, 5, 10, 20, 50, 100)


def _needed(values: Values, own: int) -> tuple[np.ndarray, int]:
    """Iterations (replicate,), and whether they are a bound."""
    factors = values.table.to_numpy().ravel()
    known = np.isfinite(factors)
    return own * np.exp(factors[known]), int(np.sign(values.bounds.to_numpy().sum()))


def _in_words(needed: float, own: int, bound: int = 0) -> str:
    """Iterations and factor."""
    sign = {1: "> ", -1: "< "}.get(bound, "")
    return f"{sign}{float(f'{needed:.2g}'):,.0f} ({needed / own:.2g}×)"


def _draw_setups(axes: Axes, setups: Values, own: int) -> float:
    """Iterations in all setups: each a dot; mean, and interval of one more study. Returns the mean."""
    its: Model = setups.model()
    beyond = (setups.bounds.max(axis=1) > 0).to_numpy()
    heights = 0.15 + 0.3 * (np.arange(len(beyond)) * 0.618 % 1 - 0.5)
    for those, marker in ((~beyond, "."), (beyond, ">")):
        sign = {"s": 16, "marker": marker, "color": STEPS[DOUBLE].color, "lw": 0}
        axes.scatter(own * np.exp(its.numbers[those]), heights[those], **sign)
    mean, low, high = own * np.exp(its.mean)
    axes.hlines(-0.3, *(own * np.exp(its.another[1:])), color=NEUTRAL, linewidth=0.8)
    axes.hlines(-0.3, low, high, color=NEUTRAL, linewidth=3)
    axes.scatter(mean, -0.3, s=MARK, marker="D", color=NEUTRAL, zorder=3)
    return mean
