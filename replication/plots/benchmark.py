"""Figures that answer what one should use today."""

from textwrap import fill
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from replication.judgement.results import Evidence
from replication.pages.real_arm import ERROR
from replication.plots.palette import BORDER, BOTH, styles_of
from replication.plots.style import band, finish, logarithmic, note, title, words

SHOWN = {
    "links_encoders": "the paper's damage",
    "noise": "measured with noise",
    "outliers": "measured with outliers",
    "links_encoders_gears_sag": "gears and sag as well",
}
UNDER = ("geometric",)  # the hybrid is often just as good, and drawn upon it
WIDTH = 20  # letters of a panel's title
AFTER = 100  # moves: the title tells who is best after them
NEARLY = 1.1
FAR = 9  # from one number of poses to the next, in relation to it
SMALLEST = 1e-4  # cm and degrees: below it, errors are drawn at the edge


def _shown(table: pd.DataFrame) -> dict[str, str]:
    """Four scenarios with what they are called: the first ones where the four are not there."""
    there = list(table["scenario"].unique())
    if set(SHOWN) <= set(there):
        return SHOWN
    return {scenario: fill(words(scenario), WIDTH) for scenario in there[: len(SHOWN)]}


def figure12(evidence: Evidence) -> Figure:
    """Errors against moves for every learner on some of the benchmark's scenarios."""
    table = evidence.table("benchmark.csv")
    shown, learners = _shown(table), styles_of(table["learner"].unique())
    size: Any = {"figsize": (1.6 + 2.25 * len(shown), 7), "squeeze": False}
    figure, panels = plt.subplots(2, len(shown), sharex=True, sharey="row", **size)
    for column, (scenario, name) in zip(panels.T, shown.items(), strict=True):
        column[0].set_title(name)
        for axes, error in zip(column, BOTH, strict=True):
            for learner, style in learners.items():
                own = table[(table["scenario"] == scenario) & (table["learner"] == learner)]
                low, middle, high = (
                    own[f"{error.column}{end}"].clip(SMALLEST) for end in ("_low", "", "_high")
                )
                band(axes, own["moves"], (low, high), style.color)
                axes.plot(
                    own["moves"],
                    middle,
                    marker=style.marker or None,
                    markersize=7 if learner in UNDER else 4,
                    linewidth=5 if learner in UNDER else 1.4,
                    color=style.color,
                    label=style.label,
                )
            if axes in panels[:, 0]:
                axes.set_ylabel(error.label)
            logarithmic(axes.xaxis, 1, 10, 100, 1000, 10_000)
            logarithmic(axes.yaxis, 0.0001, 0.001, 0.01, 0.1, 1, 10)
            axes.set_ylim(SMALLEST, 30)
    for axes in panels[-1]:
        axes.set_xlabel("robot moves")
        axes.tick_params(axis="x", labelsize=9)
    best, wins = _best(table[table["scenario"].isin(shown)])
    finish(
        figure,
        f"Figure 12: after {AFTER} moves, {learners[best].label} has the smallest position error,"
        f" or nearly so, in {wins} of {len(shown)} scenarios",
        panels[0, 0],
        4,
        f"means over {table['seeds'].max()} seeds; bands: 95 % bootstrap intervals; errors below"
        f" {SMALLEST:g} are drawn there",
    )
    return figure


def _best(table: pd.DataFrame) -> tuple[str, int]:
    """The learner whose position error is most often the smallest or `NEARLY` so: in how many.

    Errors that are drawn at the edge are equal.
    """
    measured = table[table["moves"] <= AFTER]
    last = measured[measured["moves"] == measured.groupby("learner")["moves"].transform("max")]
    errors = last.pivot(index="scenario", columns="learner", values=BOTH[0].column).clip(SMALLEST)
    wins = errors.le(NEARLY * errors.min(axis=1), axis=0).sum()
    return wins.idxmax(), wins.max()


def figure13(evidence: Evidence) -> Figure:
    """The real arm: errors on the test poses against the number of recorded poses."""
    table, published = evidence.table("real.csv"), evidence.facts["published_mm"]["after_mm"]
    figure, axes = plt.subplots(figsize=(9, 4.6))
    shown = styles_of(learner.split()[0] for learner in table["learner"].unique())
    for learner, own in table.groupby("learner", sort=False):
        name, _, twin = learner.partition(" ")
        style = shown[name]
        label: str | None = f"{style.label} {twin}".strip()
        # no line where nothing was measured in between
        for _, piece in own.groupby((own["poses"].pct_change() > FAR).cumsum()):
            band(axes, piece["poses"], (piece[f"{ERROR}_low"], piece[f"{ERROR}_high"]), style.color)
            axes.plot(
                piece["poses"],
                piece[ERROR],
                color=style.color,
                marker=style.marker or None,
                linestyle=(0, (4, 2)) if twin else "-",
                label=label,
            )
            label = None
    axes.axhline(published, **BORDER)
    note(axes, f"published: {published} mm", (3000, published), (0, -12), fontsize=9)
    axes.set_xlabel("recorded poses (moves on the twin)")
    axes.set_ylabel("mean position error, test poses [mm]")
    logarithmic(axes.xaxis, 5, 10, 20, 50, 100, 200, 500, 1000, 20_000)
    logarithmic(axes.yaxis, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
    axes.tick_params(axis="x", labelsize=9)
    figure.legend(loc="outside right center")
    own = table[~table["learner"].str.contains(" ")]
    enough = own.loc[own[ERROR] < published, "poses"].min()
    beaten = f"{enough:.0f} poses are enough to beat" if np.isfinite(enough) else "no learner beats"
    robot = evidence.facts["real_robot"].upper()
    title(
        figure,
        f"Figure 13: on a real {robot}, {beaten} the published error",
        f"means over random subsets of the {own['poses'].max():,} recorded poses;"
        " bands: 95 % bootstrap intervals",
    )
    return figure
