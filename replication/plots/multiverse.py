"""What a multiverse is: every setup a path through all that the paper leaves open."""

import textwrap
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.judgement.claims import figure_1
from replication.judgement.results import Evidence
from replication.pages.words import level_in_words
from replication.plots.palette import FAILS, HOLDS
from replication.plots.style import title

SHOWN = "robot", "home", "assignment", "cells", "effort", "tool"  # of all factors
WIDE = 11  # characters of a column
HALF = 0.3  # of a column: lines stop where its words stand


def multiverse(evidence: Evidence) -> Figure:
    """The paths of all setups through some of the choices, and what came of them."""
    figure, axes = plt.subplots(figsize=(10.5, 4.6))
    ((_, setups),) = figure_1.CLAIM.setups(evidence).items()
    design, limit = setups.levels, setups.across.limit()
    holds = setups.model.numbers < limit
    levels = {factor: sorted(map(str, design[factor].unique())) for factor in SHOWN}
    paths = np.stack([_heights(design[factor], levels[factor]) for factor in SHOWN], axis=1)
    ends = _ends(holds)
    nudge = np.linspace(-0.02, 0.02, len(paths))[:, None]
    paths = np.concatenate([paths + nudge, ends[:, None]], axis=1)
    steps = np.arange(len(SHOWN) + 1.0)
    for path, its in zip(paths, holds, strict=True):
        # pale and dark, too: the colours alone are much the same grey to some
        style: Any = {"color": HOLDS, "alpha": 0.4} if its else {"color": FAILS, "zorder": 2.5}
        for ways in zip(steps[:-1] + HALF, steps[1:] - HALF, path[:-1], path[1:], strict=True):
            axes.plot(ways[:2], ways[2:], linewidth=0.6, **style)
    for step, factor in enumerate(SHOWN):
        _column(axes, step, evidence.words()[factor], levels[factor])
    for share, words in ((holds, "a tenth of both\nerrors remains,\nor less"), (~holds, "more")):
        if share.any():
            axes.annotate(
                words, (steps[-1] - HALF + 0.06, ends[share].mean()), va="center", fontsize=10
            )
    axes.set(xlim=(-0.45, steps[-1] + 0.75), ylim=(-0.02, 1.22))
    axes.axis("off")
    title(
        figure,
        f"A multiverse: in {holds.sum()} of {len(design)} alternative setups, a tenth of both"
        " errors remains, or less",
        "Where the paper is silent, something has to be chosen. Each line is a setup: the whole"
        f" replication with other choices; {len(SHOWN)} of its {design.shape[1]} choices are"
        " shown.\nRight: what remains of the initial errors after learning, the mean of a setup's"
        " replicates",
    )
    return figure


def _heights(column, levels: list[str]) -> np.ndarray:
    spread = np.linspace(0, 1, len(levels) + 2)[1:-1]
    return spread[[levels.index(str(value)) for value in column]]


def _ends(holds: np.ndarray) -> np.ndarray:
    """Where each setup ends: those in which the claim holds above the others, in order."""
    order = np.argsort(np.argsort(~holds, kind="stable"), kind="stable")
    return 0.95 - 0.9 * (order + 2 * ~holds) / (len(holds) + 1)


def _column(axes: Axes, step: int, words: dict[str, str], levels: list[str]) -> None:
    asks = textwrap.fill(f"{words['asks']}\N{NO-BREAK SPACE}...", WIDE)
    axes.annotate(asks, (step, 1), ha="center", va="bottom", fontsize=9, fontweight="bold")
    heights = np.linspace(0, 1, len(levels) + 2)[1:-1]
    for height, level in zip(heights, levels, strict=True):
        axes.annotate(
            textwrap.fill(level_in_words(words, level), WIDE),
            (step, height),
            ha="center",
            va="center",
            fontsize=9,
        )
