"""The figures of the multiverse: does a claim hold in every reading, and what moves it?"""

import textwrap
from collections.abc import Iterator
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.effects import effects
from recalib.study.evidence.results import Evidence
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import BORDER, FAILS, HOLDS, NEUTRAL, plain, title

COLUMNS = 3
WIDEST = 42  # characters above a panel
SHOWN = 5  # factors of each claim
TICKS = {  # by an axis's end
    1.12: (1, 1.05, 1.1),
    1.25: (1, 1.1, 1.2),
    2.2: (1, 1.2, 1.5, 2),
    np.inf: (1, 2, 3, 5, 10),
}


class Panel(NamedTuple):
    """A claim, or its part about one system."""

    claim: str
    short: str
    system: str
    across: Across
    limit: float

    @property
    def heading(self) -> str:
        """The claim in a line or two, and below it the system, if it is about one."""
        return f"{textwrap.fill(self.short, WIDEST)}\n{self.system.removeprefix('the ')}"


def panels() -> Iterator[Panel]:
    """All claims that universes vary, in the paper's order."""
    for claim in CLAIMS:
        short = claim.short.split(":")[0]
        for system, across in claim.across.items():
            limit = float(claim.limits[across.limit])
            yield Panel(claim.id, short, system, across, limit)


def _grid(height: float) -> tuple[Figure, list[Axes], list[Panel]]:
    shown = list(panels())
    rows = -(-len(shown) // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(11, height * rows), squeeze=False)
    for spare in axes.flat[len(shown) :]:
        spare.remove()
    return figure, list(axes.flat[: len(shown)]), shown


def _within(values: pd.Series) -> pd.Series:
    """Infinite ones, of what was not reached, a little above the others."""
    finite = values[np.isfinite(values)]
    return values.clip(upper=1.3 * finite.max())


def figure14(evidence: Evidence) -> Figure:
    """Specification curves: what was measured for each claim in every universe, in order."""
    figure, all_axes, shown = _grid(2.4)
    outcomes = evidence.outcomes()
    for axes, panel in zip(all_axes, shown, strict=True):
        holds = panel.across.holds(outcomes, panel.limit)
        values = _within(outcomes[panel.across.column])
        order = np.argsort(values, kind="stable")
        rank = np.empty(len(order))
        rank[order] = np.arange(1, len(order) + 1)
        for mask, color, marker in ((holds, HOLDS, "o"), (~holds, FAILS, "x")):
            axes.scatter(rank[mask], values[mask], s=9, color=color, marker=marker, linewidth=0.8)
        axes.axhline(panel.limit, **BORDER)
        axes.set(yscale=LOG, xlim=(0, len(order) + 1))
        axes.set_xticks([1, len(order)])
        axes.set_ylabel(panel.across.number, fontsize=8)
        axes.tick_params(labelsize=8)
        if np.isinf(outcomes[panel.across.column]).any():
            above = {"xy": (0.98, 0.86), "xycoords": "axes fraction", "ha": "right", "fontsize": 8}
            axes.annotate(f"not reached: above {panel.limit:g}", **above)
        low, high = values.min(), values.max()
        plain(axes.yaxis, *_ticks(low, high, panel.limit))
        side = "below" if panel.across.below else "above"
        axes.set_title(
            f"{panel.heading}{': ' * bool(panel.system)}"
            f"{side} {panel.limit:g} in {holds.sum()} of {len(holds)}",
            fontsize=9,
        )
    title(
        figure,
        "Figure 14: does each claim hold, whatever one chooses where the paper is silent?",
        f"each sign is one of {len(outcomes)} universes: another robot, damage, convention, search"
        " and seeds; in order of what was measured.\nGreen dots: the claim holds there; dark"
        " crosses: it does not; the line parts them",
    )
    return figure


def _ticks(low: float, high: float, limit: float) -> list[float]:
    """Three numbers of a logarithmic axis: the limit, and where the measurements end."""
    found = {float(f"{limit:.2g}")}
    for end in (low, high):
        if abs(np.log(end / limit)) > 0.25 * np.log(max(high, limit) / min(low, limit)):
            found.add(float(f"{end:.2g}"))
    return sorted(found)


def figure15(evidence: Evidence) -> Figure:
    """What each claim depends on: the factors that move its number most."""
    figure, all_axes, shown = _grid(2.1)
    outcomes, design = evidence.outcomes(), evidence.design()
    for axes, panel in zip(all_axes, shown, strict=True):
        values = outcomes[panel.across.column]
        axes.set_title(panel.heading.strip(), fontsize=9, loc="right")
        if values.nunique() == 1:
            axes.set(xticks=[], yticks=[])
            middle = {"xy": (0.5, 0.5), "xycoords": "axes fraction", "ha": "center", "fontsize": 8}
            axes.annotate("the same in all", **middle)
            continue
        luck = evidence.rng("effects", panel.claim, panel.system)
        table = effects(values, design, luck).head(SHOWN).iloc[::-1]
        heights = np.arange(len(table))
        strong = table["effect"] > table["chance"]
        axes.hlines(heights, table["low"], table["high"], color=np.where(strong, NEUTRAL, "0.6"))
        axes.scatter(
            table["effect"], heights, s=22, zorder=3, color=np.where(strong, NEUTRAL, "0.6")
        )
        axes.scatter(table["chance"], heights, s=60, marker="|", color="black", zorder=2)
        names = [
            f"{row.factor}: {row.least} < {row.largest}".replace("_", " ")
            for row in table.itertuples()
        ]
        axes.set_yticks(heights, names, fontsize=7)
        axes.set(xscale=LOG, xlim=(0.95, None), ylim=(-0.6, len(table) - 0.4))
        end = axes.get_xlim()[1]
        plain(axes.xaxis, *next(ticks for most, ticks in TICKS.items() if end < most))
        axes.grid(axis="y", visible=False)
        axes.tick_params(axis="x", labelsize=8)
    title(
        figure,
        "Figure 15: what does each claim depend on?",
        "for each claim the five choices that move its number most, beyond chance: from the level"
        " where it is smallest to the one where it is largest, how many times as large?\nlines:"
        " 95 % bootstrap intervals over universes; | : in 95 % of cases no choice without any"
        " effect goes beyond; grey: no more than that",
    )
    return figure
