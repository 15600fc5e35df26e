"""What a multiverse is: every universe a path through all that the paper leaves open."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.evidence.claims import figure_1
from recalib.study.evidence.results import Evidence
from recalib.study.plots.explained.sketch import INK
from recalib.study.plots.style import FAILS, HOLDS, title

SHOWN = {  # of all factors, and what they are about
    "robot": "which robot?",
    "home": "where is the\nworkspace?",
    "assignment": "which links\nand encoders?",
    "norm": "how far is\na pose?",
    "cells": "how many\ncells?",
    "effort": "how hard\na search?",
}


def multiverse(evidence: Evidence) -> Figure:
    """The paths of all universes through some of the choices, and what came of them."""
    figure, axes = plt.subplots(figsize=(10.5, 4.2))
    outcomes, design = evidence.outcomes(), evidence.design()
    across, limit = figure_1.CLAIM.across[""], float(figure_1.CLAIM.limits["left"])
    holds = np.asarray(across.holds(outcomes, limit))
    levels = {factor: sorted(map(str, design[factor].unique())) for factor in SHOWN}
    paths = np.stack([_heights(design[factor], levels[factor]) for factor in SHOWN], axis=1)
    ends = _ends(holds)
    nudge = np.linspace(-0.02, 0.02, len(paths))[:, None]
    paths = np.concatenate([paths + nudge, ends[:, None]], axis=1)
    steps = np.arange(paths.shape[1])
    for path, its in zip(paths, holds, strict=True):
        # pale and dark, too: the colours alone are much the same grey to some
        look = {"color": HOLDS, "alpha": 0.4} if its else {"color": FAILS, "zorder": 2.5}
        axes.plot(steps, path, linewidth=0.5, **look)
    for step, (factor, question) in enumerate(SHOWN.items()):
        _column(axes, step, question, levels[factor])
    for share, words in ((holds, "it holds"), (~holds, "it does not")):
        text = f"{words}\nin {share.sum()}"
        axes.annotate(text, (steps[-1] + 0.06, ends[share].mean()), va="center")
    axes.set(xlim=(-0.4, steps[-1] + 0.7), ylim=(-0.02, 1.25))
    axes.axis("off")
    title(
        figure,
        f"A multiverse: {len(design)} ways to replicate one paper",
        f"each line is a universe, a small study of its own; {len(SHOWN)} of its"
        f" {design.shape[1]} choices are shown.\n"
        "The claim of Figure 1 holds where a tenth of both errors is left, or less",
    )
    return figure


def _heights(column, levels: list[str]) -> np.ndarray:
    spread = np.linspace(0, 1, len(levels) + 2)[1:-1] if len(levels) > 1 else np.array([0.5])
    return spread[[levels.index(str(value)) for value in column]]


def _ends(holds: np.ndarray) -> np.ndarray:
    """Where each universe ends: those in which the claim holds above the others, in order."""
    order = np.argsort(np.argsort(~holds, kind="stable"), kind="stable")
    return 0.95 - 0.9 * (order + 2 * ~holds) / (len(holds) + 1)


def _column(axes: Axes, step: int, question: str, levels: list[str]) -> None:
    axes.annotate(question, (step, 1.08), ha="center", va="bottom", fontsize=10, fontweight="bold")
    heights = np.linspace(0, 1, len(levels) + 2)[1:-1]
    axes.scatter(np.full(len(levels), step), heights, s=26, color=INK, zorder=3)
    for height, level in zip(heights, levels, strict=True):
        axes.annotate(
            level.replace("_", " "),
            (step, height),
            (0, 6),
            textcoords="offset points",
            ha="center",
            fontsize=9,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
            zorder=4,
        )
