"""The figure of the speed-up: learners trained for several numbers of iterations."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.claims import speed_up as claim
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.speedup import speed_up
from recalib.study.plots.looks import DASHED, LOOKS, looks
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import INTERVALS, LABELS, plain, title

LEVELS = (0.3, 0.2, 0.15, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03)  # of both initial errors
TOP = 300


def figure9(evidence: Evidence) -> Figure:
    """The ladders of iterations and the speed-up over error levels."""
    figure, panels = plt.subplots(1, 3, figsize=(12, 4.4))
    ladders = {name: evidence.ladder(name) for name in (IMPROVED, RITTER)}
    for name, look in looks(ladders).items():
        means = np.array([errors.mean(axis=0) for errors in ladders[name].values()])
        for kind, axes in enumerate(panels[:2]):
            axes.plot(
                list(ladders[name]),
                means[:, kind],
                marker=look.marker,
                label=look.label.capitalize(),
                **look.line(),
            )
    for axes, label in zip(panels[:2], LABELS.values(), strict=True):
        axes.set(xscale=LOG, yscale=LOG, xlabel="iterations, tuned for each number", ylabel=label)
        plain(axes.xaxis, 100, 1000, 10_000)
        plain(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 4)
    panels[0].legend(fontsize=9)
    _draw_factors(panels[2], evidence, ladders)
    seeds = {len(errors) for ladder in ladders.values() for errors in ladder.values()}
    title(
        figure,
        "Figure 9: how many times as many iterations does Ritter's map need?",
        f"means over {' or, for long trainings, '.join(map(str, sorted(seeds)[::-1]))} seeds;"
        f" {INTERVALS}",
    )
    return figure


def _draw_factors(axes: Axes, evidence: Evidence, ladders: dict) -> None:
    slow, fast, own = ladders[RITTER], ladders[IMPROVED], evidence.fact("iterations")
    initial = evidence.errors(evidence.fact("improved"), moment="first").mean(axis=0)
    color = LOOKS[IMPROVED].color
    for level in LEVELS:
        factor = speed_up(slow, fast, level * initial, evidence.rng("level", str(level)))
        if np.isfinite(factor.mean):
            # beyond the top where Ritter's, in some resamples, does not get there on its ladder
            high = min(factor.high, 10 * TOP)
            axes.vlines(100 * level, factor.low, high, color=color)
            axes.scatter(100 * level, factor.mean, color=color, zorder=3)
    ours = speed_up(slow, fast, own, evidence.rng("speed-up"))
    if np.isfinite(ours.mean):
        axes.scatter(
            100 * (fast[own].mean(axis=0) / initial).max(),
            ours.mean,
            s=120,
            marker="*",
            color="black",
            zorder=4,
            label=f"after {own} iterations: {ours.mean:.0f}",
        )
    axes.axhline(
        claim.FACTOR,
        color=LOOKS[RITTER].color,
        linestyle=DASHED,
        label=f"the paper: about {claim.FACTOR}",
    )
    axes.set(
        xscale=LOG,
        yscale=LOG,
        xlabel="both errors within [% of the initial ones]",
        ylabel="Ritter's iterations / improved",
        ylim=(1, TOP),
    )
    plain(axes.xaxis, 3, 5, 10, 20, 30)
    plain(axes.yaxis, 1, 3, 10, 30, 100, 300)
    axes.invert_xaxis()
    axes.legend(fontsize=9, loc="lower right")
