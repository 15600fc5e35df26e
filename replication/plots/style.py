"""The common style of all figures, and functions for common lines and axes.

The width suits a phone, which shows letters of 9 pixels. Enlarged to the width of a page or of the
article, all letters have more than 10 points.
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

WIDTH = 5.0  # inches
SMALL = 9  # points, size of the smallest letters
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
    "axes.axisbelow": True,  # the grid is below the data
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
    "svg.hashsalt": "recalib",  # makes identifiers reproducible
    "svg.fonttype": "none",
}
BAND = (5, 95)  # percent of the runs
GOLDEN = 0.618  # its multiples fill [0, 1] evenly, modulo 1
MARK = 28  # points squared, size of a marker


def save(figure: Figure, *paths: str | Path) -> None:
    """Write a figure to files, without a date: unchanged results give identical files."""
    for path in map(Path, paths):
        with whole(path) as temporary:
            figure.savefig(
                temporary, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None}
            )
    plt.close(figure)


def logarithmic(axis: Axis, *ticks: float) -> None:
    """Make an axis logarithmic, with labels only at these values, as plain numbers."""
    (axis.axes.set_xscale if axis is axis.axes.xaxis else axis.axes.set_yscale)("log")
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(StrMethodFormatter("{x:,g}"))
    axis.set_minor_locator(NullLocator())


def name_rows(axes: Axes, heights: ArrayLike, names: Iterable[str]) -> None:
    """Write the names of rows at these heights to the left."""
    axes.set_yticks(heights, list(names))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)


def name_right(axes: Axes, heights: ArrayLike, names: Iterable[str]) -> SecondaryAxis:
    """Write texts to the right of rows at these heights; return their axis."""
    right = axes.secondary_yaxis("right")
    right.set_yticks(heights, list(names))
    right.tick_params(length=0)
    right.spines["right"].set_visible(False)
    return right


def spread(count: int) -> np.ndarray:
    """Heights (count,) about 0 that spread the points of a row, so that they overlap less."""
    return 0.3 * (np.arange(count) * GOLDEN % 1 - 0.5)


def band(axes: Axes, places: ArrayLike, ends: Sequence[ArrayLike], color: str) -> None:
    """Fill the area between lower and upper ends, in a paler colour than the line's."""
    low, high = ends
    axes.fill_between(places, low, high, color=color, alpha=0.2, linewidth=0)


def note(
    axes: Axes, text: str, at: tuple[float, float], points: tuple[float, float], **font: Any
) -> None:
    """Write text at an offset `points` (right, up) from a place in the data."""
    axes.annotate(text, at, points, textcoords="offset points", **font)


def legend_below(figure: Figure, axes: Axes, columns: int) -> None:
    """Put the legend of one panel, for all panels, below the figure, where it hides no data."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def words(scenario: str) -> str:
    """A scenario's name as text."""
    return scenario.replace("_", " and ")
