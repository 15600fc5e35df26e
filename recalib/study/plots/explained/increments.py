"""Why increments: one correction shared with the neighbours, as a value and as a change."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from recalib.learners.nets import regular_grid
from recalib.study.evidence.results import Evidence
from recalib.study.plots.explained.sketch import INK
from recalib.study.plots.palette import styles_of
from recalib.study.plots.style import title

CELLS = regular_grid((9,))[:, 0]
WINNER, WIDTH = 6, 0.6  # of the neighbourhood, in workspace coordinates


def wanted(poses: np.ndarray) -> np.ndarray:
    """The commands of a damaged robot, not far from those of a healthy one: the poses."""
    return 0.94 * poses + 0.3


def increments(evidence: Evidence) -> Figure:
    """Equations (4) and (7) at work in one dimension, after a single correction."""
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(10.5, 4.4))
    near = np.exp(-0.5 * ((CELLS - CELLS[WINNER]) / WIDTH) ** 2)
    learned = wanted(CELLS[WINNER])  # the winner's new command
    values = CELLS + near * (learned - CELLS)  # (4)
    changes = CELLS + near * (learned - CELLS[WINNER])  # (7)
    texts = ("Ritter: all move towards its new value", "improved: all move by its change")
    for axes, after, style, text in zip(
        panels, (values, changes), styles_of(["ritter", "improved"]).values(), texts, strict=True
    ):
        axes.plot(CELLS, CELLS, color="0.6", label="before the damage")
        axes.plot(CELLS, wanted(CELLS), color=INK, linestyle=(0, (5, 2)), label="what is right now")
        axes.vlines(CELLS, CELLS, after, color=style.color, linewidth=1, alpha=0.6)
        axes.scatter(CELLS, after, color=style.color, zorder=3, label="cells after one correction")
        axes.annotate(
            "corrected here",
            (CELLS[WINNER], learned),
            (-10, 38),
            textcoords="offset points",
            ha="right",
            arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkB": 5},
        )
        axes.set(xlabel="desired pose", ylim=(-1.15, 1.75))
        axes.set_title(text, fontweight="normal")
        axes.legend(loc="lower right", fontsize=10)
    panels[0].set_ylabel("command")
    title(
        figure,
        "What neighbouring cells learn from one correction",
        "one dimension, nine cells, one wide neighbourhood; the damage is slight, so that what is"
        " right now looks like what was right before",
    )
    return figure
