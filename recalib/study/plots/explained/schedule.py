"""What the schedule does: how long each width lasts, and how often a cell is visited meanwhile."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from recalib.learners.schedules import DIMENSIONS, equal_visits, expected_learning, exponential
from recalib.study.evidence.results import Evidence
from recalib.study.plots.palette import styles_of
from recalib.study.plots.style import title

START, END = 1.5, 0.3  # widths, in workspace coordinates
ITERATIONS = 200
STEP = 0.1  # of the width, in which visits are counted
VOLUME = 2.0**DIMENSIONS
LAWS = {"ritter": exponential, "improved": equal_visits}
NAMES = {"ritter": "Ritter: exponential", "improved": "improved: equal visits"}


def schedule(evidence: Evidence) -> Figure:
    """Equation (10) at work, far from the border of the workspace."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.4))
    done = np.linspace(0, 1, 1001)
    for name, style in styles_of(LAWS).items():
        widths = LAWS[name](START, END, done)
        left.plot(ITERATIONS * done, widths, label=NAMES[name], **style.line())
        iterations = ITERATIONS * STEP / np.abs(np.gradient(widths, done))  # spent at each width
        visits = iterations * expected_learning(widths, DIMENSIONS, VOLUME)
        right.plot(widths, visits, label=NAMES[name], **style.line())
    left.set(xlabel="iterations", ylabel="width of the neighbourhood", ylim=(0, None))
    left.set_title("wide at first, narrow in the end", fontweight="normal")
    left.legend(fontsize=10)
    right.set(xlabel="width of the neighbourhood", ylabel=f"visits of a cell for {STEP:g} of width")
    right.set_ylim(bottom=0)
    right.set_title("how often are cells visited meanwhile?", fontweight="normal")
    title(
        figure,
        "How fast neighbourhoods shrink",
        f"from {START:g} to {END:g} half workspaces in {ITERATIONS} iterations; a cell that learns"
        " half of a correction counts as half a visit",
    )
    return figure
