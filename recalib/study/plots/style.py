"""What all figures share: one style, legible in black and white and to the colour-blind, and files that do not change."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from recalib.storage import whole

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
LABELS = {
    "position_error_cm": "position error [cm]",
    "orientation_error_deg": "orientation error [degrees]",
}
# Okabe and Ito's palette, and a second sign each for black and white: a dash pattern and a marker.
POSITION = {"color": "#0072B2", "linestyle": "-"}
ORIENTATION = {"color": "#D55E00", "linestyle": (0, (5, 2))}
LEARNERS = {
    "improved": {
        "color": "#0072B2",
        "linestyle": "-",
        "marker": "o",
        "label": "improved, 200 iterations",
    },
    "ritter_200": {
        "color": "#E69F00",
        "linestyle": (0, (1, 1)),
        "marker": "^",
        "label": "Ritter, 200 iterations",
    },
    "ritter": {
        "color": "#D55E00",
        "linestyle": (0, (5, 2)),
        "marker": "s",
        "label": "Ritter, 10,000 iterations",
    },
}
BAND = (5, 95)  # percent of the seeds


def save(figure: Figure, *paths: str | Path) -> None:
    """Write the figure whole, without a date, so that an unchanged result leaves the file unchanged."""
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
    """The figure's one message above it, and what its signs mean below it."""
    figure.suptitle(text, fontweight="bold", fontsize=12, x=0.01, ha="left")
    if below:
        figure.supxlabel(below, fontsize=9)
