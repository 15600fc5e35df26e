"""What all figures share: one style, and the lines and axes that they have in common.

Figures are as wide as a phone shows them with letters of 9 pixels: enlarged to the width of a page
or of the article, all letters have more than 10 points.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axes._secondary_axes import SecondaryAxis
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter
from numpy.typing import ArrayLike

from recalib.files.storage import whole
from replication.plots.steady import LOG, steady

WIDTH = 5.0  # inches
SMALL = 9  # points: no letter is smaller
STYLE: Any = {
    "figure.figsize": (WIDTH, 2.8),
    "figure.dpi": 220,
    "figure.constrained_layout.use": True,
    "font.size": SMALL,
    "axes.titlesize": SMALL,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,  # the grid
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.4,
    "lines.markersize": 5,
    "legend.frameon": False,
    "legend.handlelength": 2.6,  # two whole dashes
    "legend.columnspacing": 1.2,
    "svg.hashsalt": "recalib",  # the same drawing gives the same file
    "svg.fonttype": "none",
}
BAND = (5, 95)  # percent of the runs
GOLDEN = 0.618  # its multiples fill [0, 1] evenly, modulo 1
MARK = 28  # points squared, of a sign


def save(figure: Figure, *paths: str | Path) -> None:
    """Write the figure whole, without a date: an unchanged result leaves the file unchanged."""
    steady(figure)
    for path in map(Path, paths):
        with whole(path) as temporary:
            figure.savefig(
                temporary, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None}
            )
    plt.close(figure)


def logarithmic(axis: Axis, *ticks: float) -> None:
    """Make an axis logarithmic, and label it at these values alone, as plain numbers."""
    (axis.axes.set_xscale if axis is axis.axes.xaxis else axis.axes.set_yscale)(LOG)
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(StrMethodFormatter("{x:,g}"))
    axis.set_minor_locator(NullLocator())


def name_rows(axes: Axes, heights: ArrayLike, names: Iterable[str]) -> None:
    """Name what stands in rows at these heights."""
    axes.set_yticks(heights, list(names))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)


def name_right(axes: Axes, heights: ArrayLike, names: Iterable[str]) -> SecondaryAxis:
    """Words to the right of what stands in rows at these heights; returns their axes."""
    right = axes.secondary_yaxis("right")
    right.set_yticks(heights, list(names))
    right.tick_params(length=0)
    right.spines["right"].set_visible(False)
    return right


def spread(count: int) -> np.ndarray:
    """Heights (count,) about 0 at which points of a row hide one another less."""
    return 0.3 * (np.arange(count) * GOLDEN % 1 - 0.5)


def band(axes: Axes, places: ArrayLike, ends: Sequence[ArrayLike], color: str) -> None:
    """What lies between the lower and the upper end, paler than its line."""
    low, high = ends
    axes.fill_between(places, low, high, color=color, alpha=0.2, linewidth=0)


def note(
    axes: Axes, text: str, at: tuple[float, float], points: tuple[float, float], **font: Any
) -> None:
    """Words, so many points to the right of a place in the data and above it."""
    axes.annotate(text, at, points, textcoords="offset points", **font)


def legend_below(figure: Figure, axes: Axes, columns: int) -> None:
    """The legend of one panel for all of them, below the figure, where it hides no data."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def words(scenario: str) -> str:
    """A scenario's name for people."""
    return scenario.replace("_", " and ")
