"""What all figures share: one style, and the words, lines and axes that they have in common."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter
from numpy.typing import ArrayLike

from recalib.files.storage import whole
from replication.plots.palette import BORDER, Style
from replication.plots.steady import LOG, steady

STYLE: Any = {
    "figure.figsize": (8, 4.5),
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 11,
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,  # the grid
    "grid.color": "0.9",
    "legend.fontsize": 9,
    "legend.frameon": False,
    "legend.handlelength": 2.6,  # two whole dashes
    "legend.title_fontsize": 9,
    "svg.hashsalt": "recalib",  # the same drawing gives the same file
    "svg.fonttype": "none",
}
BAND = (5, 95)  # percent of the runs
# of `statistics.Estimate`
INTERVALS = "lines: where 95 % of repetitions with other searches and seeds would lie"


def save(figure: Figure, *paths: str | Path) -> None:
    """Write the figure whole, without a date: an unchanged result leaves the file unchanged."""
    steady(figure)
    for path in map(Path, paths):
        with whole(path) as temporary:
            figure.savefig(
                temporary, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None}
            )
    plt.close(figure)


def plain(axis: Axis, *ticks: float) -> None:
    """Label an axis at these values alone, as plain numbers."""
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(StrMethodFormatter("{x:,g}"))
    axis.set_minor_locator(NullLocator())


def logarithmic(axis: Axis, *ticks: float) -> None:
    """Make an axis logarithmic, and label it at these values."""
    (axis.axes.set_xscale if axis is axis.axes.xaxis else axis.axes.set_yscale)(LOG)
    plain(axis, *ticks)


def name_rows(axes: Axes, heights: ArrayLike, names: Iterable[str]) -> None:
    """Name what stands in rows at these heights."""
    axes.set_yticks(heights, list(names))
    axes.grid(axis="y", visible=False)


def band(axes: Axes, places: ArrayLike, ends: Sequence[ArrayLike], color: str) -> None:
    """What lies between the lower and the upper end, paler than its line."""
    low, high = ends
    axes.fill_between(places, low, high, color=color, alpha=0.2, linewidth=0)


def with_intervals(
    axes: Axes,
    rows: ArrayLike,
    values: ArrayLike,
    ends: Sequence[ArrayLike],
    label: str,
    style: Style,
) -> None:
    """Signs in rows, each on the line from the lower to the upper end of its interval."""
    low, high = ends
    axes.hlines(rows, low, high, color=style.color)
    axes.scatter(values, rows, label=label, zorder=3, **style.signs())


def note(axes: Axes, text: str, at: tuple, points: tuple[float, float], **font) -> None:
    """Words, so many points to the right of a place in the data and above it."""
    axes.annotate(text, at, points, textcoords="offset points", **font)


def title(figure: Figure, text: str, below: str = "") -> None:
    """What the figure shows above it, and what its signs mean below it."""
    figure.suptitle(text, fontweight="bold", fontsize=12, x=0.01, ha="left")
    if below:
        figure.supxlabel(below, fontsize=9)


def finish(figure: Figure, text: str, axes: Axes, columns: int, explained: str) -> None:
    """The title, and below the figure, where it hides no data, the legend of one of the panels.

    Args:
        axes: whose legend is that of all panels.
        explained: what its signs mean.
    """
    title(figure, text)
    figure.legend(
        *axes.get_legend_handles_labels(),
        loc="outside lower center",
        ncols=columns,
        title=explained,
    )


def legend_under(axes: Axes) -> None:
    """The legend of a panel with signs of its own, under it."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))


def line_across(axes: Axes, text: str, x: float | None = None, y: float | None = None) -> None:
    """A line that parts one side of the axes from the other, and what it is.

    An upright one at x, or a level one at y.
    """
    upright = x is not None
    if x is not None:
        axes.axvline(x, **BORDER)
    elif y is not None:
        axes.axhline(y, **BORDER)
    note(
        axes,
        text,
        (x, 1) if upright else (1, y),
        (0, 2) if upright else (-2, 2),
        xycoords=("data", "axes fraction") if upright else ("axes fraction", "data"),
        ha="center" if upright else "right",
        va="bottom",
        fontsize=8,
        color=BORDER["color"],
    )


def words(scenario: str) -> str:
    """A scenario's name for people."""
    return scenario.replace("_", " and ").replace("-", " on the ")
