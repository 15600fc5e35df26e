"""The figure of the search for widths and rates."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.claims import rough_search, width_order
from recalib.study.evidence.results import Evidence
from recalib.study.measured import KINDS
from recalib.study.plots.looks import looks
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import BORDER, ORIENTATION, POSITION, plain, title

LEFT = {  # what the search minimises
    "worse": "larger part left of both initial errors",
    "geometric_mean": "part left of the initial errors, geometric mean",
}


def _draw_shares(axes: Axes, evidence: Evidence) -> None:
    for learner, look in looks([IMPROVED, RITTER]).items():
        ratio = np.sort(
            np.concatenate(
                [
                    trials.loc[trials["round"] == 1, "score"] / trials["score"].min()
                    for _, trials in evidence.sample(evidence.fact(learner)).groupby("search")
                ]
            )
        )
        share = np.arange(1, len(ratio) + 1) / len(ratio)
        axes.step(ratio, share, label=look.label.capitalize(), **look.line())
    axes.axvline(rough_search.CLAIM.limits["factor"], **BORDER)
    axes.set(
        xscale=LOG,
        xlabel="error of a random trial over that of its search's best",
        ylabel="share of the first rounds' trials",
    )
    plain(axes.xaxis, 1, 2, 5, 10, 20, 50, 100)
    axes.set_title("How rough may the search be?", fontsize=11)
    axes.legend(fontsize=9)


def figure6(evidence: Evidence) -> Figure:
    """What the search for the improved system found: how good, and which order of widths."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.4))
    _draw_shares(panels[0], evidence)
    improved = evidence.fact("improved")
    trials, budget = evidence.sample(improved), evidence.searched_for(improved)
    for name, style, marker in zip(KINDS, (POSITION, ORIENTATION), "os", strict=True):
        panels[1].scatter(
            trials[f"{name}/g_k"] / trials[f"{name}/g_kl"],
            trials["score"],
            s=8,
            alpha=0.4,
            color=style["color"],
            marker=marker,
            label=f"{name} map",
        )
    panels[1].axvline(width_order.CLAIM.limits["ratio"], **BORDER)
    panels[1].set(
        xscale=LOG,
        yscale=LOG,
        xlabel="final width of $g_k$ (positions) over that of $g_{kl}$ (orientations)",
        ylabel=LEFT[budget.budget.score],
    )
    plain(panels[1].xaxis, 0.1, 0.3, 1, 3, 10)
    plain(panels[1].yaxis, 0.05, 0.1, 0.2, 0.5, 1)
    panels[1].set_title("Which widths does each map want?", fontsize=11)
    panels[1].legend(
        fontsize=9,
        loc="center left",
        markerscale=2,
        frameon=True,
        framealpha=0.9,
        edgecolor="none",
    )
    title(
        figure,
        "Figure 6: what the searches see",
        f"{budget.searches} searches for the improved map, {len(trials) // budget.searches} trials"
        f" each, {budget.budget.seeds} seeds a trial; on the right, those of all searches at"
        f" {evidence.fact('iterations')} iterations",
    )
    return figure
