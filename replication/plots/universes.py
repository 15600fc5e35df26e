"""The figure of the multiverse: every claim in all alternative setups."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.special import ndtri

from replication.judgement.claims import CLAIMS
from replication.judgement.claims.across import Setups, rounded
from replication.judgement.intervals import LEVEL
from replication.judgement.results import Evidence
from replication.judgement.verdicts import CORRELATION, RATIO, Verdict
from replication.pages.words import headline, judged_by_setups, ranged, short
from replication.plots.palette import BORDER, HOLDS, NEUTRAL
from replication.plots.sheet import Sheet, write
from replication.plots.style import logarithmic, plain

LEFT, PLOT, RIGHT = 3.15, 3.7, 3.65  # inches: what is claimed, its numbers, its verdict
TALL, LESS = 0.56, 0.45  # inches of a row: of a claim, and of another system beside it
DARK, PALE = {"dots": "0.35", "mean": NEUTRAL}, {"dots": "0.7", "mean": "0.6"}
SCALES: Mapping[str, tuple[str, tuple[float, ...]]] = {  # names and ticks of axes
    "ratio": (
        "error with what the paper proposes over error without it",
        (0.05, 0.1, 0.2, 0.5, 1, 2, 4),
    ),
    "correlation": ("rank correlation", (-1, -0.5, 0, 0.5, 1)),
    "limit": ("what was measured over its limit", (0.01, 0.1, 1, 10)),
}
REACH = ndtri((1 + LEVEL) / 2)  # standard deviations


class ClaimRow(NamedTuple):
    """A claim on one of its systems."""

    statement: str
    system: str
    verdict: Verdict
    setups: Setups
    leads: bool
    reference: str  # its number and interval, where not the setups, but this study judges the claim

    @property
    def kind(self) -> str:
        """With which others it shares an axis."""
        bounded = {RATIO: "ratio", CORRELATION: "correlation"}
        return bounded.get(self.setups.across.comparison, "limit")

    @property
    def height(self) -> float:
        """In inches."""
        return TALL if self.leads else LESS

    def placed(self, values) -> np.ndarray:
        """Values, in the scale in which they are averaged, where they stand on the axis."""
        values = np.asarray(values)
        if self.kind == "correlation":
            return values
        return np.exp(values - self.setups.across.limit())


def rows(evidence: Evidence) -> list[ClaimRow]:
    """All claims that choices reach, on each of their systems."""
    judged, found = {claim["id"]: claim for claim in evidence.claims()}, []
    for claim in CLAIMS:
        its = judged[claim.id]
        systems = its["systems"] if claim.across else {}
        reference = "" if judged_by_setups(its) else headline(its)
        for place, (system, setups) in enumerate(claim.setups(evidence).items()):
            verdict = Verdict(systems[system]["verdict"])
            found.append(ClaimRow(its["statement"], system, verdict, setups, place == 0, reference))
    return found


def figure14(evidence: Evidence) -> Figure:
    """The numbers of all setups for each claim, their mean, and what of their spread is luck."""
    shown = rows(evidence)
    panels = {kind: [row for row in shown if row.kind == kind] for kind in SCALES}
    heights = [sum(row.height for row in its) for its in panels.values()]
    sheet = Sheet((LEFT, PLOT, RIGHT), heights, _heading(shown), _explained(evidence, shown), 0.6)
    for axes, (kind, its) in zip(sheet.panels, panels.items(), strict=True):
        limits, (_, top) = _scale(axes, kind), axes.get_ylim()
        for row in its:
            _draw_row(axes, row, top - row.height / 2, limits)
            top -= row.height
    heads = {-LEFT / PLOT: "the paper says", 1.03: "verdict", 1.32: "mean (95 % interval), spread"}
    for place, head in heads.items():
        sheet.head(place, head)
    sheet.legend(sheet.panels[0], 2)
    return sheet.figure


def _heading(shown: Sequence[ClaimRow]) -> str:
    leading = [row for row in shown if row.leads]
    counts = {verdict: sum(row.verdict == verdict for row in leading) for verdict in Verdict}
    supported = counts.pop(Verdict.SUPPORTED)
    others = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    text = f"Figure 14: {supported} of {len(leading)} claims that choices can change are supported"
    return f"{text}\n({others})" if others else text


def _explained(evidence: Evidence, shown: Sequence[ClaimRow]) -> str:
    choices, outcomes = evidence.levels().shape[1], evidence.setups("outcomes")
    replicates = 0 if outcomes is None else outcomes["replicate"].nunique()
    return (
        f"The paper leaves at least {choices} choices open, such as the robot or the search. Each"
        " dot is the whole replication made again with other choices: a setup,\nthe mean of its"
        f" {replicates} replicates. Bold line in the shaded part: supported, unless the"
        " study with the choices of this project says the opposite. Paler: other systems."
    )


def _draw_row(axes: Axes, row: ClaimRow, middle: float, limits: tuple[float, float]) -> None:
    model, style = row.setups.model, DARK if row.leads else PALE
    comparison, ends = row.setups.across.comparison, np.array(limits)
    (limit,) = row.placed([row.setups.across.limit()])
    side = (limits[0], limit) if comparison.below else (limit, limits[1])
    half = 0.47 * row.height
    label: dict[str, Any] = {"label": "here the paper is right"} if row.leads else {}
    axes.fill_between(side, middle - half, middle + half, color=HOLDS, alpha=0.18, lw=0, **label)
    axes.vlines(limit, middle - half, middle + half, **BORDER)
    if comparison.bounds:
        axes.vlines(
            comparison.bounds,
            middle - half,
            middle + half,
            color=BORDER["color"],
            linewidth=0.8,
            linestyle=":",
            label="between them: too little to matter",
        )
    upper, lower = middle + 0.11, middle - 0.13
    mean, luck = model.mean.mean, np.sqrt(np.square(model.luck_of_numbers).mean())
    band = np.clip(row.placed([mean - REACH * luck, mean + REACH * luck]), *ends)
    alone = f"{LEVEL:.0%} of the dots, if all setups were alike: luck alone".replace("%", " %")
    axes.hlines(upper, *band, color="0.85", linewidth=15, label=alone, zorder=1)
    _dots(axes, row.placed(np.sort(model.numbers)), upper, limits, style["dots"])
    another = np.clip(row.placed(model.another[1:]), *ends)
    axes.hlines(lower, *another, color=style["mean"], linewidth=0.8, label=OTHERS)
    interval = np.clip(row.placed(model.mean[1:]), *ends)
    axes.hlines(lower, *interval, color=style["mean"], linewidth=3, label=MEAN)
    (at,) = np.clip(row.placed([mean]), *ends)
    axes.scatter(at, lower, s=34, marker="D", color=style["mean"], zorder=3)
    _write(axes, row, middle)


OTHERS = "thin line: where 95 % of other setups would lie, without luck"
MEAN = "diamond: mean over the setups; bold line: its 95 % interval"


def _dots(
    axes: Axes, numbers: np.ndarray, height: float, limits: tuple[float, float], color: str
) -> None:
    """Each setup a dot, spread a little in height; an arrow where it lies beyond the axis."""
    heights = height + 0.13 * (np.arange(len(numbers)) * 0.618 % 1 - 0.5)
    low, high = limits
    for where, at, marker, label in (
        ((numbers >= low) & (numbers <= high), numbers, ".", "a setup"),
        (numbers < low, np.full_like(numbers, low), "<", None),
        (numbers > high, np.full_like(numbers, high), ">", None),
    ):
        if where.any():
            axes.scatter(
                at[where], heights[where], s=20, marker=marker, color=color, lw=0, label=label
            )


def _write(axes: Axes, row: ClaimRow, middle: float) -> None:
    limit = row.setups.across.comparison
    against = "" if limit.bounds else f", limit {limit.limit:g}"
    lines = [*textwrap.wrap(row.statement, 46)] if row.leads else []
    what = "\n".join([*lines, f"{row.system}{against}"])
    color = NEUTRAL if row.leads else "0.4"
    write(axes, -LEFT / PLOT, middle, what, color=color)
    weight = "bold" if row.leads else "normal"
    write(axes, 1.03, middle, row.verdict, color=color, weight=weight)
    write(axes, 1.32, middle, "\n".join(_numbers(row)), color=color)


def _numbers(row: ClaimRow) -> list[str]:
    setups = row.setups
    across, measured = setups.across, len(setups.model.numbers)
    mean, *ends = map(rounded, setups.mean)  # as pages have them
    number = ranged(mean, ends)
    of = f"over {measured} of {measured + setups.left_out} setups"
    parts = {"setups": setups.model.heterogeneity.mean, "luck": setups.model.luck.mean}
    spread = [f"{_spread(its, across.logarithmic)} by {name}" for name, its in parts.items()]
    lines = [f"{number} {of}" if setups.left_out else number, f"spread {', '.join(spread)}"]
    if row.reference:
        lines.insert(1, f"reference study: {row.reference}")
    if (counted := setups.holds) is not None:
        lines.append(f"holds in {counted[0]} of {measured}; {counted[1]:.0f} if all were alike")
    return lines


def _spread(deviation: float, logarithmic: bool) -> str:
    """A standard deviation: as a part, or as a factor where it is large."""
    if not logarithmic:
        return short(deviation)
    part = np.expm1(deviation)
    return f"{100 * part:.0f} %" if part < 1 else f"×{1 + part:.2g}"


def _scale(axes: Axes, kind: str) -> tuple[float, float]:
    """Make the axis of a kind of claims; returns its ends."""
    label, ticks = SCALES[kind]
    low, high = ticks[0], ticks[-1]
    axes.set_xlabel(label)
    if kind == "correlation":
        pad = 0.02 * (high - low)
        axes.set_xlim(low - pad, high + pad)
        plain(axes.xaxis, *ticks)
    else:
        pad = (high / low) ** 0.02
        logarithmic(axes.xaxis, *ticks)
        axes.set_xlim(low / pad, high * pad)
    return low, high
