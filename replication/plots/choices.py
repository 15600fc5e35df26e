"""The figure of single choices: what the numbers of the multiverse depend on."""

import textwrap
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.judgement.claims import CLAIMS
from replication.judgement.results import Evidence, Words
from replication.pages.words import level_in_words, short
from replication.plots.palette import BORDER, NEUTRAL
from replication.plots.sheet import Sheet, write
from replication.plots.style import logarithmic, plain

if TYPE_CHECKING:
    import pandas as pd

LEFT, PLOT, RIGHT = 5.0, 3.7, 1.8  # inches: the choice, its effect, its number
HEADING, ROW, GAP = 0.22, 0.36, 0.1  # inches
STRONGEST = 3  # choices of a claim
LINE = 145  # characters as wide as the sheet
ON_LINES: dict[str, Any] = {"bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1}}
TICKS = 1, 1.5, 2, 3, 5, 10, 20, 50


def figure15(evidence: Evidence) -> Figure:
    """For each claim the choices that move its number beyond chance, three at most."""
    logarithmic: dict[str, pd.DataFrame] = {}
    others: dict[str, pd.DataFrame] = {}
    unmoved = []
    for claim in CLAIMS:
        for system, setups in list(claim.setups(evidence).items())[:1]:
            effects = setups.effects(evidence.rng("effects", claim.id, system))
            beyond = effects[effects["effect"] > effects["chance"]].head(STRONGEST)
            what = f"{claim.statement.rstrip('.')} ({setups.across.number})"
            if beyond.empty:
                unmoved.append(claim.statement.rstrip("."))
            else:
                (logarithmic if setups.across.logarithmic else others)[what] = beyond
    scales = [(its, scale) for its, scale in ((logarithmic, _times), (others, _more)) if its]
    heights = [sum(map(_height, its.values())) for its, _ in scales]
    rest = textwrap.wrap(f"No choice moves these beyond chance: {'; '.join(unmoved)}.", LINE)
    below = 0.2 + 0.17 * len(rest) if unmoved else 0.0
    sheet = Sheet((LEFT, PLOT, RIGHT), heights, *_words(evidence, scales, len(unmoved)), below)
    for axes, (its, scale) in zip(sheet.panels, scales, strict=True):
        scale(axes, its, evidence.words())
    if unmoved:
        sheet.note("\n".join(rest))
    return sheet.figure


def _height(effects: "pd.DataFrame") -> float:
    return HEADING + ROW * len(effects) + GAP


def _words(evidence: Evidence, scales, unmoved: int) -> tuple[str, str]:
    moved = sum(len(its) for its, _ in scales)
    factors = [factor for its, _ in scales for table in its.values() for factor in table["factor"]]
    text = f"Figure 15: {moved} of {moved + unmoved} claims depend on a choice beyond chance"
    if factors:
        text += f";\nno choice moves more than {max(map(factors.count, factors))} of them"
    explained = (
        "Where the paper is silent, something has to be chosen. For each claim: the choice with"
        " which its number is largest, instead of the one with which it is\nsmallest, averaged over"
        f" all {evidence.levels().shape[1] - 1} others. Shown is what exceeds chance, which alone"
        " would show some choice for 1 claim in 20. Lines: 95 % intervals."
    )
    return text, explained


def _times(axes: Axes, its: Mapping[str, "pd.DataFrame"], words: Words) -> None:
    most = max(table["high"].max() for table in its.values())
    end = max(2.1, 1.05 * most)
    logarithmic(axes.xaxis, *(tick for tick in TICKS if tick < end))
    axes.set(xlim=(0.95, end), xlabel="how many times as large; 1: the same")
    _draw(axes, its, words, 1, "{} times")


def _more(axes: Axes, its: Mapping[str, "pd.DataFrame"], words: Words) -> None:
    axes.set(xlim=(-0.02, 1), xlabel="by how much larger; 0: the same")
    plain(axes.xaxis, 0, 0.2, 0.4, 0.6, 0.8, 1)
    _draw(axes, its, words, 0, "by {}")


def _draw(
    axes: Axes, its: Mapping[str, "pd.DataFrame"], words: Words, none: float, said: str
) -> None:
    """Claims from above."""
    _, top = axes.get_ylim()
    for what, effects in its.items():
        top -= HEADING
        write(axes, -LEFT / PLOT, top + 0.08, what, weight="bold", **ON_LINES)
        axes.vlines(none, top - ROW * len(effects), top, **BORDER)  # not through the heading
        for row in effects.itertuples():
            top -= ROW
            middle = top + ROW / 2
            its_words = words[row.factor]
            largest, least = (level_in_words(its_words, its) for its in (row.largest, row.least))
            choice = f"{its_words['asks']}: {largest},\ninstead of: {least}"
            write(axes, -LEFT / PLOT + 0.04, middle, choice)
            axes.hlines(middle, row.low, row.high, color=NEUTRAL)
            axes.scatter(row.effect, middle, s=26, color=NEUTRAL, zorder=3)
            number, low, high = map(_two, (row.effect, row.low, row.high))
            write(axes, 1.03, middle, f"{said.format(number)} ({low} to {high})")
        top -= GAP


def _two(value: float) -> str:
    return f"{value:.2f}" if value < 10 else short(value)
