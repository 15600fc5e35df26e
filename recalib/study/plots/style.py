"""What all figures share: one style, legible in black and white and to the colour-blind."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from recalib.storage import whole
from recalib.study.measured import ERRORS
from recalib.study.plots.looks import DASHED, SOLID
from recalib.study.plots.steady import steady

STYLE = {
    "figure.figsize": (8, 4.5),
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 11,
    "axes.titlesize": 12,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "legend.frameon": False,
    "svg.hashsalt": "recalib",  # the same drawing gives the same file
    "svg.fonttype": "none",
}
LABELS = dict(zip(ERRORS, ("position error [cm]", "orientation error [degrees]"), strict=True))
POSITION = {"color": "#0072B2", "linestyle": SOLID}
ORIENTATION = {"color": "#D55E00", "linestyle": DASHED}
BAND = (5, 95)  # percent of the runs
# of `statistics.Estimate`
INTERVALS = "lines: where 95 % of repetitions with other searches and seeds would lie"
BORDER = {"color": "0.4", "linewidth": 0.8}  # a line that parts one side from the other


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
    """Label a logarithmic axis at these values, as plain numbers."""
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_locator(NullLocator())


def title(figure: Figure, text: str, below: str = "") -> None:
    """What the figure shows above it, and what its signs mean below it."""
    figure.suptitle(text, fontweight="bold", fontsize=12, x=0.01, ha="left")
    if below:
        figure.supxlabel(below, fontsize=9)


def legend_below(figure: Figure, axes: Axes, columns: int, text: str) -> None:
    """The legend of one of the panels for all of them, below the figure."""
    figure.legend(
        *axes.get_legend_handles_labels(),
        loc="outside lower center",
        ncols=columns,
        fontsize=9,
        title=text,
        title_fontsize=9,
    )


def words(scenario: str) -> str:
    """A scenario's name for people."""
    return scenario.replace("_", " and ").replace("-", " on the ")
