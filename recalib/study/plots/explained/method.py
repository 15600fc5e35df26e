"""The method in one picture: the learning cycle, and the two nets that learn."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from recalib.learners.nets import Nets
from recalib.study.evidence.results import Evidence
from recalib.study.plots.explained.sketch import INK, LEARNED, arrow, blank, box
from recalib.study.plots.palette import BOTH, FAILS
from recalib.study.plots.style import title

NETS = Nets((3, 3, 1), (3, 3, 1))  # one layer of each net
WIDTH = 0.9  # of all neighbourhoods, in workspace coordinates: which is wider is searched for


def method(evidence: Evidence) -> Figure:
    """What happens in an iteration, and how the cells lie in the workspace."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 5), width_ratios=[1.15, 1])
    _cycle(left)
    _nets(right)
    title(
        figure,
        "The arm learns which fake pose to send, from where it went",
        "the darker a cell, the more of the change it learns;"
        " each of the four neighbourhoods has its own width.\n"
        "A second, corrected move teaches each cell how commands must change with poses",
    )
    return figure


def _cycle(axes: Axes) -> None:
    blank(axes, 10, 9)
    box(axes, 1.7, 8, "desired\npose $u$")
    box(axes, 5.6, 8, "the nearest cell\nof each map", LEARNED)
    box(axes, 8.9, 5.6, "fake pose $\\theta'$", LEARNED)
    box(axes, 8.6, 3.2, "controller,\nas it always was")
    box(axes, 6, 1, "damaged arm")
    box(axes, 1.9, 1, "where it\nwent: $u'$")
    box(axes, 1.9, 4.4, "miss\n$u - u'$", FAILS)
    arrow(axes, (2.55, 8), (3.95, 8))
    arrow(axes, (7.2, 7.8), (8.9, 6.05), bend=-0.25)
    arrow(axes, (8.85, 5.2), (8.75, 3.8))
    arrow(axes, (8.5, 2.6), (7.35, 1.1), bend=-0.2)
    arrow(axes, (4.65, 1), (2.75, 1))
    arrow(axes, (1.9, 1.6), (1.9, 3.8))
    arrow(axes, (1.75, 7.4), (1.85, 5.0))
    arrow(axes, (2.65, 4.4), (5.3, 7.4), FAILS, bend=0.2, width=2.5)
    axes.text(
        4.55,
        4.55,
        "corrects the cell,\nand its neighbours\nby the same change",
        color=FAILS,
        va="center",
        fontsize=10,
    )


def _nets(axes: Axes) -> None:
    blank(axes, 10, 9.6)
    axes.text(2.6, 9.2, "supernet:\npositions", ha="center", va="center")
    axes.text(7.6, 9.2, "a subnet in each cell:\norientations", ha="center", va="center")
    winner = np.array([4]), np.array([4])
    learns = NETS.neighbourhood(*winner, *np.full((2, 1), WIDTH))
    for y, error in zip((6.6, 2.4), BOTH, strict=True):
        name, color = error.kind, error.color
        shades = LinearSegmentedColormap.from_list(name, ["white", color])
        axes.text(-0.5, y, f"{name}\nmap", color=color, fontweight="bold", ha="center", va="center")
        arrow(axes, (2.95, y), (5.85, y), bend=-0.25)
        for x, cells, (g,), sign in zip(
            (2.6, 7.6), (NETS.w_k, NETS.w_kl), learns, ("$g_k$", "$g_{kl}$"), strict=True
        ):
            points = np.array([x, y]) + 1.7 * cells[:, :2]
            style = {"c": shades(np.round(g, 3)), "edgecolors": INK, "linewidths": 0.8}
            axes.scatter(*points.T, s=200, zorder=3, **style)
            axes.text(x, y - 1.75, f"neighbourhood {sign}", ha="center", va="top", fontsize=10)
