"""The figure of the speed-up: learners trained for several numbers of iterations."""

from itertools import chain, zip_longest

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.config.switches import IMPROVED
from replication.judgement.factor import CELLS, DOUBLE, PUBLISHED, leading
from replication.judgement.intervals import estimate
from replication.judgement.results import Evidence
from replication.judgement.speedup import speed_up
from replication.pages.words import ranged
from replication.plots.palette import BORDER, BOTH, Style, styles_of
from replication.plots.style import INTERVALS, logarithmic, title

SMALL = 9.5  # points: a label no wider than its panel

LEVELS = (0.3, 0.2, 0.15, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03)  # of both initial errors
TOP = 300


def figure9(evidence: Evidence) -> Figure:
    """The ladders of iterations and the speed-up over error levels."""
    figure, panels = plt.subplots(1, 3, figsize=(10, 4.6))
    ladders = {name: evidence.ladder(name) for name in (IMPROVED, *CELLS)}
    for name, style in styles_of(ladders).items():
        rungs = list(ladders[name])
        for kind, axes in enumerate(panels[:2]):
            rows = [
                estimate(errors[..., kind], evidence.rng("ladder", name, str(rung), str(kind)))
                for rung, errors in ladders[name].items()
            ]
            means, low, high = np.transpose(rows)
            axes.vlines(rungs, low, high, color=style.color, alpha=0.6)
            label = _named(name, style)
            axes.plot(rungs, means, marker=style.marker, label=label, **style.line())
    for axes, error in zip(panels[:2], BOTH, strict=True):
        axes.set_xlabel("iterations, tuned for each number", fontsize=SMALL)
        axes.set_ylabel(error.label, fontsize=SMALL)
        logarithmic(axes.xaxis, 100, 1000, 10_000)
        logarithmic(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 4, 8)
    _draw_factors(panels[2], evidence, ladders)
    searches = sorted({len(errors) for ladder in ladders.values() for errors in ladder.values()})
    text = f"Figure 9: with as many cells as {CELLS[DOUBLE]},\n{_needs(evidence, ladders)}"
    means = f"means over {' or, for short trainings, '.join(map(str, searches))} searches"
    own = evidence.facts["iterations"]
    spread = (
        f"{means} and their seeds; {INTERVALS};\nan arrow at the border: it goes on;"
        f" stars: for the errors that the improved system has after {own} iterations"
    )
    title(figure, text)
    learners, factors = (
        zip(*axes.get_legend_handles_labels(), strict=True) for axes in (panels[0], panels[2])
    )
    # below each learner its factor, and below the improved system the published one
    signs = filter(None, chain.from_iterable(zip_longest(learners, factors)))
    figure.legend(
        *zip(*signs, strict=True), loc="outside lower center", ncols=len(ladders), title=spread
    )
    return figure


def _needs(evidence: Evidence, ladders: dict) -> str:
    """What Ritter's needs in the leading reading; the end of its ladder where that is a bound."""
    factor, own = leading(evidence, DOUBLE), evidence.facts["iterations"]
    first, last = min(ladders[DOUBLE]) / own, max(ladders[DOUBLE]) / own
    if np.isnan(factor.mean):
        return f"Ritter's needs at most {first:g} times as many iterations"
    if np.isinf(factor.mean):
        return f"Ritter's needs more than {last:g} times as many iterations"
    within = max(factor.low, first), factor.high

    def said(value: float) -> str:
        return f"more than {last:.0f}" if value > last else f"{value:.0f}"

    return f"Ritter's needs {ranged(factor.mean, within, said)} times as many iterations"


def _named(name: str, style: Style) -> str:
    return f"Ritter's, cells of {CELLS[name]}" if name in CELLS else style.label


def _draw_factors(axes: Axes, evidence: Evidence, ladders: dict) -> None:
    fast, own = ladders[IMPROVED], evidence.facts["iterations"]
    initial = evidence.errors(evidence.facts["improved"], moment="first").mean(axis=(0, 1))
    axes.axhline(PUBLISHED, label=f"the paper: about {PUBLISHED} times", **BORDER)
    for place, (name, style) in enumerate(styles_of(CELLS).items()):
        aside = 1.02 ** (1 if place else -1)  # so that the lines of both can be seen
        goals, rng = [level * initial for level in LEVELS], evidence.rng("levels", name)
        factors = speed_up(ladders[name], fast, goals, rng)
        for level, factor in zip(LEVELS, factors, strict=True):
            if np.isfinite(factor.mean):
                # beyond the ends where a learner, in some studies, does not get there
                there, (low, high) = 100 * level * aside, np.clip(factor[1:], 1, TOP)
                axes.vlines(there, low, high, color=style.color)
                for end, marker in ((1, "v"), (TOP, "^")):
                    if end in (low, high):
                        axes.scatter(
                            there, end, s=20, marker=marker, color=style.color, clip_on=False
                        )
                axes.scatter(there, factor.mean, zorder=3, **style.signs())
        ours = leading(evidence, name)
        if np.isfinite(ours.mean):
            final = ladders[IMPROVED][own].mean(axis=(0, 1))
            axes.scatter(
                100 * np.max(final / initial),
                ours.mean,
                s=120,
                marker="*",
                facecolors="none",  # over the signs of other levels
                edgecolors=style.color,
                zorder=4,
                label=f"{ours.mean:.0f} times as many",
            )
    axes.set_xlabel("both errors within [% of the initial]", fontsize=SMALL)
    axes.set_ylabel("Ritter's iterations / improved", fontsize=SMALL)
    logarithmic(axes.xaxis, 3, 5, 10, 20, 30)
    logarithmic(axes.yaxis, 1, 3, 10, 30, 100, 300)
    axes.set_ylim(0.8, 1.25 * TOP)
    axes.margins(x=0.1)
