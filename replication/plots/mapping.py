"""The figure of the paper's claims about damage and mapping, before any learning."""

from contextlib import suppress

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.config.shipped import CAMPAIGN
from replication.judgement.claims.section_4 import WEAK
from replication.judgement.claims.section_5 import integral_ratios
from replication.judgement.claims.section_6 import AWAY
from replication.judgement.evidence import Evidence, NotMeasured
from replication.plots.palette import BORDER, BOTH, DASHED, GREY, NEUTRAL, SOLID, Style
from replication.plots.style import MARK, WIDTH, logarithmic, name_rows, note, spread
from replication.scenarios.assignments import TIE
from replication.training.measured import ERRORS

COMMANDS = Style(NEUTRAL, "o", SOLID, "commands")
JACOBIANS = Style(GREY, "s", DASHED, "Jacobians")
ASIDE = 0.22  # of a row's height: position commands above, orientation commands below


def mapping(evidence: Evidence) -> Figure:
    """Initial errors of assignments, coupling, E_upd / E_clas, and equation (10)."""
    figure, panels = plt.subplots(2, 2, figsize=(WIDTH, 4.6))
    free = [*panels.ravel()]
    for draw in (_assignments, _coupling, _propagation, _visits):
        with suppress(NotMeasured):  # some studies do not have the first two
            draw(free[0], evidence)
            free.pop(0)
    for axes in free:
        axes.remove()
    return figure


def _assignments(axes: Axes, evidence: Evidence) -> None:
    """The initial errors of all assignments of the paper's damage to the study's robot."""
    table = evidence.assignments()
    errors = table[list(ERRORS)].to_numpy()
    axes.scatter(
        errors[:, 0], errors[:, 1], s=2, alpha=0.3, color="0.5", linewidths=0, rasterized=True
    )
    used = errors[table["distance"].round(TIE).argmin()]
    paper = evidence.study.paper_damage.published
    published = paper.position_error_cm, paper.orientation_error_deg
    axes.scatter([used[0]], [used[1]], 2 * MARK, facecolors="none", edgecolors=NEUTRAL, zorder=3)
    axes.scatter(published[:1], published[1:], 2 * MARK, NEUTRAL, marker="+", zorder=4)
    axes.annotate(
        "published,\nused",
        published,
        (0.02, 1),
        textcoords="axes fraction",
        va="top",
        arrowprops={"arrowstyle": "-", "color": NEUTRAL, "linewidth": 0.6, "shrinkB": 6},
    )
    axes.set(xlabel="position [cm]", ylabel="orientation [degrees]", xlim=(0, None), ylim=(0, None))
    axes.set_title("initial errors")


def _coupling(axes: Axes, evidence: Evidence) -> None:
    """The coupling of both commands in each setup, by robot."""
    table = evidence.table(f"{CAMPAIGN}/untrained.csv").set_index("setup")
    robots = evidence.levels()["robot"].reindex(table.index)
    names = [*robots.unique()]
    rows = robots.map(names.index).to_numpy()
    axes.vlines(WEAK, 0.5 - len(names), 0.5, **BORDER)
    for error, side in zip(BOTH, (1, -1), strict=True):
        heights = ASIDE * side + spread(len(rows)) - rows
        axes.scatter(table[error.kind], heights, s=0.5 * MARK, alpha=0.7, **error.signs())
    axes.set(xlabel="off-diagonal / diagonal", ylim=(0.5 - len(names), 1.1))
    logarithmic(axes.xaxis, 0.01, 0.03, 0.1, 0.3)
    name_rows(axes, -np.arange(len(names)), [name.upper() for name in names])
    axes.set_title("coupling")
    for error, place in zip(BOTH, ("left", "right"), strict=True):
        at = (float(place == "right"), 1)
        font = {"ha": place, "va": "top", "color": error.color}
        note(axes, error.kind, at, (0, 0), xycoords="axes fraction", **font)


def _propagation(axes: Axes, evidence: Evidence) -> None:
    """E_upd / E_clas for the true mappings, from slight to large damage."""
    ratios = integral_ratios(evidence.mapping("propagation"))
    for style, line, aside in (
        (COMMANDS, ratios["theta", "intact"], (8, -3)),
        (JACOBIANS, ratios["jacobian", "damaged"], (-6, 4)),
    ):
        line = line.dropna()
        axes.plot(line.index, line, markersize=3.5, marker=style.marker, **style.line())
        middle, side = len(line) // 2, "left" if aside[0] > 0 else "right"
        at = line.index[middle - 1], line.iloc[middle - 1]
        note(axes, style.label, at, aside, ha=side, color=style.color)
    axes.axhline(1, **BORDER)
    axes.set(xlabel="size of the damage", ylabel="$E_{upd}$ / $E_{clas}$")
    logarithmic(axes.xaxis, 0.1, 1, 10)
    logarithmic(axes.yaxis, 0.0001, 0.001, 0.01, 0.1, 1)
    axes.set_title("what to propagate")


def _visits(axes: Axes, evidence: Evidence) -> None:
    """The ratio of simulated to expected learning, (10), against a cell's distance from a face."""
    table = evidence.mapping("visits")
    axes.axvline(AWAY, **BORDER)
    axes.axhline(1, linestyle=DASHED, **BORDER)
    axes.scatter(table["distance"] / table["width"], table["ratio"], s=0.4 * MARK, color=NEUTRAL)
    axes.set(xlabel="distance / width", ylabel="simulated / eq. (10)", xlim=(-0.2, 6.2))
    axes.set_ylim(0, 1.15)
    axes.set_title("expected learning")
