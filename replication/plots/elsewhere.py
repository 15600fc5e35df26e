"""The figure of other damages and other robots."""

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.config.switches import IMPROVED, RITTER
from replication.judgement.results import Evidence
from replication.plots.palette import BOTH, styles_of
from replication.plots.style import legend_under, logarithmic, title


def figure11(evidence: Evidence) -> Figure:
    """Other assignments, other amounts and other robots."""
    figure, panels = plt.subplots(1, 3, figsize=(10.4, 5.4))
    tables = {
        learner: evidence.table(f"ensemble/assignments.{learner}.parquet")
        for learner in (IMPROVED, RITTER)
    }
    _draw_assignments(panels[0], tables)
    _draw_amounts(panels[1], evidence)
    remaining = _draw_robots(panels[2], evidence)
    for axes in panels:
        legend_under(axes)
    robots = [*evidence.facts["elsewhere"]]
    title(
        figure,
        f"Figure 11: on all robots, less than {math.ceil(remaining.max())} % of the error remains"
        " (improved system)",
        f"widths and rates as tuned for the paper's damage on the {robots[0].upper()}; bands:"
        f" 5-95 % of the assignments;\n{len(tables[IMPROVED])} for the improved system,"
        f" {len(tables[RITTER])} for Ritter's after {_iterations(evidence, RITTER):,} iterations",
    )
    return figure


def _draw_assignments(axes: Axes, tables: dict) -> None:
    for error in BOTH:
        for learner, style in styles_of(tables).items():
            values = np.sort(tables[learner][f"final_{error.column}"])
            axes.step(
                values,
                np.arange(1, len(values) + 1) / len(values),
                color=style.color,
                linestyle=error.linestyle,
                label=f"{style.label}, {error.unit}",
            )
    axes.set(xlabel="final error [cm, degrees]", ylabel="share of the assignments")
    logarithmic(axes.xaxis, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
    axes.set_title("Other links, encoders and signs")


def _draw_amounts(axes: Axes, evidence: Evidence) -> None:
    scaled = evidence.table(f"ensemble/scaled.{IMPROVED}.parquet").groupby("scale")
    color = styles_of([IMPROVED])[IMPROVED].color
    for error in BOTH:
        for moment, shade in (("initial", "0.5"), ("final", color)):
            low, middle, high = (
                scaled[f"{moment}_{error.column}"].quantile(q) for q in (0.05, 0.5, 0.95)
            )
            axes.fill_between(middle.index, low, high, color=shade, alpha=0.12, linewidth=0)
            style = {"color": shade, "linestyle": error.linestyle, "marker": error.marker}
            axes.plot(middle.index, middle, label=f"{moment} {error.unit}", **style)
    axes.set(xlabel="size of the damage, times the paper's", ylabel="error [cm, degrees]")
    logarithmic(axes.xaxis, 0.1, 0.3, 1, 3)
    logarithmic(axes.yaxis, 0.01, 0.1, 1, 10)
    axes.set_title("Other amounts (improved)")


def _iterations(evidence: Evidence, learner: str) -> int:
    """After which its errors are final."""
    scenario = next(iter(evidence.facts["elsewhere"].values()))
    return evidence.history(learner, scenario)["iteration"].max()


def _draw_robots(axes: Axes, evidence: Evidence) -> np.ndarray:
    """Draw the larger remaining error in percent; returns the improved system's (robots,)."""
    shown = {}
    robots, learners = evidence.facts["elsewhere"], styles_of(evidence.facts["learners"])
    places = np.arange(len(robots))
    offsets = 0.2 * (np.arange(len(learners)) - (len(learners) - 1) / 2)
    for offset, (learner, style) in zip(offsets, learners.items(), strict=True):
        remaining = [
            np.max(
                evidence.errors(learner, scenario).mean(axis=(0, 1))
                / evidence.errors(learner, scenario, "first").mean(axis=(0, 1))
            )
            for scenario in robots.values()
        ]
        shown[learner] = 100 * np.array(remaining)
        axes.scatter(
            places + offset,
            shown[learner],
            label=f"{style.label}, {_iterations(evidence, learner):,} iterations",
            zorder=3,
            **style.signs(),
        )
    axes.set_ylabel("larger remaining error [%]")
    logarithmic(axes.yaxis, 2, 5, 10, 20, 50, 100)
    axes.set_xticks(places, [robot.upper() for robot in robots])
    axes.set_title("Other robots")
    return shown[IMPROVED]
