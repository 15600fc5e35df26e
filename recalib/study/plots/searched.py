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
from recalib.study.plots.style import (
    BORDER,
    ORIENTATION,
    POSITION,
    at_line,
    legend_under,
    plain,
    title,
)

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
        axes.step(ratio, share, label=look.label, **look.line())
    factor = rough_search.CLAIM.limits["factor"]
    axes.axvline(factor, **BORDER)
    at_line(axes, f"{factor:g} times the best", x=factor)
    axes.set(
        xscale=LOG,
        xlabel="error of a random trial over that of its search's best",
        ylabel="share of the first rounds' trials",
    )
    plain(axes.xaxis, 1, 2, 5, 10, 20, 50, 100)
    axes.set_title("How rough may the search be?\n", fontsize=11)
    legend_under(axes, 2)


def figure6(evidence: Evidence) -> Figure:
    """What the search for the improved system found: how good, and which order of widths."""
    figure, panels = plt.subplots(1, 3, figsize=(12, 4.6))
    _draw_shares(panels[0], evidence)
    improved = evidence.fact("improved")
    trials, budget = evidence.sample(improved), evidence.searched_for(improved)
    equal = width_order.CLAIM.limits["ratio"]
    panels[2].sharey(panels[1])
    for axes, name, style in zip(panels[1:], KINDS, (POSITION, ORIENTATION), strict=True):
        ratio = trials[f"{name}/g_k"] / trials[f"{name}/g_kl"]
        axes.scatter(ratio, trials["score"], s=5, alpha=0.5, color=style["color"], linewidths=0)
        axes.axvline(equal, **BORDER)
        at_line(axes, "equally wide", x=equal)
        axes.set(xscale=LOG, yscale=LOG, xlabel="final width of $g_k$ over that of $g_{kl}$")
        plain(axes.xaxis, 0.1, 0.3, 1, 3, 10)
        plain(axes.yaxis, 0.05, 0.1, 0.2, 0.5, 1)
        axes.set_title(f"What the {name} map wants\n", fontsize=11)
    panels[1].set_ylabel(LEFT[budget.budget.score])
    title(
        figure,
        "Figure 6: what the searches see",
        f"dots: all trials for the improved map at {evidence.fact('iterations')} iterations,"
        f" {len(trials) // budget.searches} in each of {budget.searches} searches,"
        f" {budget.budget.seeds} seeds a trial",
    )
    return figure
