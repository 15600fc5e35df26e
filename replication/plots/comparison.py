"""Figures that compare the paper's and today's learners, in simulation and on a real arm."""

from textwrap import fill

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.judgement.evidence import Evidence
from replication.plots.palette import BORDER, BOTH, GREY, STYLES, Style, styles_of
from replication.plots.style import WIDTH, band, legend_below, logarithmic, note, words

SHOWN = {
    "links_encoders": "the paper's damage",
    "links_encoders_gears_sag": "gears and sag as well",
}
LINE = 20  # letters in a line of a panel's title
UNDER = "geometric"  # drawn wider, because the curve of the hybrid often covers it
FAR = 9  # relative step between numbers of poses, above which a curve is interrupted
SMALLEST = 1e-4  # cm: smaller errors are drawn at the edge
REAL = "position_error_mm"


def benchmark(evidence: Evidence) -> Figure:
    """Position errors against robot moves, for every learner in two scenarios."""
    table = evidence.table("benchmark.csv")
    scenarios = [*table["scenario"].unique()]
    titles = {scenario: fill(words(scenario), LINE) for scenario in scenarios[:2]}
    shown = SHOWN if {*SHOWN} <= {*scenarios} else titles
    learners = styles_of(table["learner"])
    figure, panels = plt.subplots(
        1, len(shown), sharex=True, sharey=True, squeeze=False, figsize=(WIDTH, 3.4)
    )
    for axes, (scenario, name) in zip(panels[0], shown.items(), strict=True):
        for learner, style in learners.items():
            results = table[(table["scenario"] == scenario) & (table["learner"] == learner)]
            _draw(axes, results.set_index("moves"), BOTH[0].column, style, style.label)
        axes.set_title(name)
        axes.set_xlabel("robot moves")
        logarithmic(axes.xaxis, 1, 100, 10_000)
        logarithmic(axes.yaxis, 0.0001, 0.001, 0.01, 0.1, 1, 10)
        axes.set_ylim(SMALLEST, 20)
    panels[0, 0].set_ylabel(BOTH[0].label)
    legend_below(figure, panels[0, 0], 3)
    return figure


def real_arm(evidence: Evidence) -> Figure:
    """The real arm: errors on the test poses against the number of recorded poses."""
    table, published = evidence.table("real.csv"), evidence.study.real.published.after_mm
    figure, axes = plt.subplots(figsize=(WIDTH, 3.8))
    styles = styles_of(table["learner"])
    for (learner, twin), results in table.groupby(["learner", "twin"], sort=False):
        # no line across a large gap without measurements
        pieces = (results["poses"].pct_change() > FAR).cumsum()
        for number, piece in results.groupby(pieces):
            label = styles[learner].label + (" on a twin" if twin else "")
            shown = None if number else label
            _draw(axes, piece.set_index("poses"), REAL, styles[learner], shown)
    axes.axhline(published, **BORDER)
    font = {"va": "top", "ha": "right", "color": GREY}
    note(axes, f"published: {published:.2g} mm", (table["poses"].max(), published), (0, -2), **font)
    axes.set_xlabel("recorded poses, or moves on the twin")
    axes.set_ylabel("mean position error [mm]")
    logarithmic(axes.xaxis, 5, 20, 100, 500, 2000, 20_000)
    logarithmic(axes.yaxis, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
    legend_below(figure, axes, 3)
    return figure


def _draw(axes: Axes, table: pd.DataFrame, error: str, style: Style, label: str | None) -> None:
    """Draw means and intervals of a learner against the table's index."""
    low, middle, high = (table[f"{error}{end}"].clip(SMALLEST) for end in ("_low", "", "_high"))
    under = style is STYLES[UNDER]
    band(axes, table.index, (low, high), style.color)
    axes.plot(
        table.index,
        middle,
        marker=style.marker or None,
        markersize=6 if under else 3.5,
        linewidth=4 if under else 1.2,
        label=label,
        **style.line(),
    )
