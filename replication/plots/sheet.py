"""A sheet of panels with columns of words beside them: figures that are tables, too."""

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.layout_engine import PlaceHolderLayoutEngine

SMALL = 8.5  # points: on a sheet of 10.5 inches, 9 pixels on a page of 830
EDGE = 0.1  # inches
ABOVE, BETWEEN = 1.3, 0.62  # inches: title and what explains it; a panel's axis


class Sheet:
    """Panels over each other, as wide as the middle one of three columns.

    An inch of the sheet is a unit of a panel's vertical axis, which goes up from 0.

    Args:
        columns: widths [inch] of the words on the left, the panels, the words on the right.
        heights: of the panels [inch].
        below: inches for a legend.
    """

    def __init__(
        self,
        columns: tuple[float, float, float],
        heights: Sequence[float],
        title: str,
        explained: str,
        below: float = 0.0,
    ):
        wide = sum(columns)
        tall = ABOVE + sum(heights) + BETWEEN * len(heights) + below
        # With layout="none", saving a figure would bring back that of the style.
        self.figure = plt.figure(figsize=(wide, tall), layout=PlaceHolderLayoutEngine(True, True))
        self.panels: list[Axes] = []
        left = (columns[0] + EDGE) / wide
        top = tall - ABOVE
        for height in heights:
            top -= height
            box = (left, top / tall, (columns[1] - EDGE) / wide, height / tall)
            axes = self.figure.add_axes(box)
            axes.set(ylim=(0, height), yticks=[])
            axes.tick_params(labelsize=SMALL)
            axes.xaxis.label.set_fontsize(SMALL + 0.5)
            axes.spines["left"].set_visible(False)
            self.panels.append(axes)
            top -= BETWEEN
        self.figure.suptitle(
            title, fontweight="bold", fontsize=12, x=EDGE / wide, y=1 - EDGE / tall, ha="left"
        )
        self.figure.text(
            EDGE / wide, 1 - (ABOVE - 0.3) / tall, explained, fontsize=SMALL + 0.5, va="bottom"
        )

    def head(self, place: float, text: str) -> None:
        """What a column is, above the first panel: from this part of the panel's width."""
        axes = self.panels[0]
        write(axes, place, sum(axes.get_ylim()) + 0.07, text, va="baseline", style="italic")

    def note(self, text: str) -> None:
        """Words below all panels."""
        wide, tall = self.figure.get_size_inches()
        self.figure.text(EDGE / wide, EDGE / tall, text, fontsize=SMALL, va="bottom")

    def legend(self, axes: Axes, columns: int) -> None:
        """Signs of a panel, each once, below all of them."""
        handles, labels = axes.get_legend_handles_labels()
        signs = dict(zip(labels, handles, strict=True))
        self.figure.legend(
            signs.values(), signs, loc="lower left", ncols=columns, fontsize=SMALL + 0.5
        )


def write(axes: Axes, place: float, height: float, text: str, **font: Any) -> None:
    """Words beside a panel: from this part of its width, about this height [inch]."""
    style: Any = {"fontsize": SMALL, "va": "center", "linespacing": 1.15, **font}
    axes.text(place, height, text, transform=axes.get_yaxis_transform(), **style)
