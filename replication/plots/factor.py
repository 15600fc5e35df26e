"""The figure of the factor: the iterations that each step from Ritter's map on needs."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.campaign.variants import DOUBLE, TWO_MAPS
from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims.section_7 import PUBLISHED
from replication.judgement.contrasts import SHARES, Crossing, Remaining, Values
from replication.judgement.evidence import Evidence
from replication.plots.palette import BORDER, GREY, NEUTRAL, STYLES, Style
from replication.plots.style import MARK, WIDTH, logarithmic, name_right, name_rows, note, spread

# Styles by variant, from Ritter's map to the improved system; learners have their usual colours.
STEPS: Mapping[str, Style] = {
    RITTER: Style("#757575", "^", "-", "Ritter, half the cells"),
    DOUBLE: Style(STYLES[RITTER].color, "P", "-", "Ritter, equal cells"),
    TWO_MAPS: Style("#661100", "X", "-", "two maps"),
    "two_maps_jacobian": Style("#CD87AD", "v", "-", "+ Jacobian increments"),
    "two_maps_theta": Style("#05AB6E", "D", "-", "+ command increments"),
    "two_maps_increments": Style("#61D6FF", "s", "-", "+ both increments"),
    IMPROVED: Style(STYLES[IMPROVED].color, "o", "-", "improved: + equal visits"),
}
ENDS = 45, 45_000  # iterations


def steps(evidence: Evidence) -> Figure:
    """Top: errors of each step; bottom: iterations it needs for the improved system's errors."""
    reference, outcomes = evidence.study.experiments.iterations, evidence.outcomes()
    goal, home = Remaining(IMPROVED, reference), outcomes[outcomes["setup"] == 0]
    shown = {name: style for name, style in STEPS.items() if name in set(home["variant"])}
    setups = Crossing(DOUBLE, goal).values(outcomes)
    figure, (above, below) = plt.subplots(
        2, 1, sharex=True, figsize=(WIDTH, 4.8), height_ratios=[1, 1.5]
    )
    texts = []
    for height, (variant, style) in zip(range(len(shown), 0, -1), shown.items(), strict=True):
        rows = home[home["variant"] == variant]
        shares = np.log(100 * rows[SHARES].max(axis=1)).groupby(rows["iterations"]).mean()
        signs = {"markersize": 3.5, "marker": style.marker, **style.line()}
        above.plot(shares.index, np.exp(shares), **signs)
        needed, bound = np.array([reference]), 0
        if variant != IMPROVED:
            needed, bound = _needed(Crossing(variant, goal).values(home), reference)
        middle = float(np.exp(np.log(needed).mean()))
        below.hlines(height, reference, middle, color=style.color, linewidth=3)
        below.scatter(needed, [height] * len(needed), s=MARK, zorder=3, **style.signs())
        texts.append(_in_words(middle, reference, bound))
    texts.append(_in_words(_draw_setups(below, setups, reference), reference))
    names = [style.label for style in shown.values()]
    names.append(f"Ritter, equal cells,\n{len(setups.table)} setups")
    below.axhline(0.5, **BORDER)
    heights = range(len(shown), -1, -1)
    name_rows(below, heights, names)
    name_right(below, heights, texts)
    below.set(xlim=ENDS, ylim=(-0.7, len(shown) + 0.6))
    below.set_xlabel("iterations (each length tuned)")
    logarithmic(below.xaxis, 50, 200, 1000, 5000, 20_000)
    level = 100 * np.exp(goal.values(home).table.to_numpy().mean())
    above.axhline(level, color=STEPS[IMPROVED].color, linewidth=0.8)
    above.set_ylabel("larger remaining\nshare [%]")
    logarithmic(above.yaxis, 1, 2, 5, 10, 20, 50, 100)
    for axes in (above, below):
        axes.axvline(reference * PUBLISHED, linestyle=(0, (4, 3)), **BORDER)
    font = {"xycoords": ("data", "axes fraction"), "va": "top", "color": GREY}
    note(above, f"the paper:\n{PUBLISHED}×", (reference * PUBLISHED, 1), (3, 0), **font)
    return figure


def _needed(values: Values, reference: int) -> tuple[np.ndarray, int]:
    """Iterations (replicate,), and the sign of their bound: 1: at least, -1: at most, 0: none."""
    factors = values.table.to_numpy().ravel()
    finite = np.isfinite(factors)
    return reference * np.exp(factors[finite]), int(np.sign(values.bounds.to_numpy().sum()))


def _in_words(needed: float, reference: int, bound: int = 0) -> str:
    sign = {1: "> ", -1: "< "}.get(bound, "")
    iterations, factor = (float(f"{value:.2g}") for value in (needed, needed / reference))
    return f"{sign}{iterations:,g} ({factor:,g}×)"


def _draw_setups(axes: Axes, setups: Values, reference: int) -> float:
    """Draw iterations in all setups, and the predictive interval of one more. Return their mean."""
    model = setups.model()
    beyond = (setups.bounds.max(axis=1) > 0).to_numpy()
    heights = 0.15 + spread(len(beyond))
    for mask, marker in ((~beyond, "."), (beyond, ">")):
        iterations, color = reference * np.exp(model.numbers[mask]), STEPS[DOUBLE].color
        axes.scatter(iterations, heights[mask], s=16, marker=marker, color=color, lw=0)
    mean, low, high = reference * np.exp(model.mean)
    axes.hlines(-0.3, *(reference * np.exp(model.another[1:])), color=NEUTRAL, linewidth=0.8)
    axes.hlines(-0.3, low, high, color=NEUTRAL, linewidth=3)
    axes.scatter(mean, -0.3, s=MARK, marker="D", color=NEUTRAL, zorder=3)
    return float(mean)
