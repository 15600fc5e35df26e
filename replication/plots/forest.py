"""The figure of the setups: the number of each claim in every setup."""

from collections.abc import Mapping
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from replication.judgement.claims import claims
from replication.judgement.claims.claim import OfSetups
from replication.judgement.contrasts import Crossing, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding
from replication.judgement.verdicts import Verdict
from replication.plots.palette import BORDER, HOLDS, NEUTRAL
from replication.plots.style import MARK, WIDTH, logarithmic, name_right, name_rows, spread

ROW = 0.28  # inches, height of a row
DECADES = 0.01, 0.1, 1, 10, 100
TICKS = sorted([*DECADES, 0.03, 0.3, 3, 30])  # if there is room for them
ROOM = 100  # ratio of an axis's ends, below which there is room
MARGIN = 1.15  # factor from the extreme numbers to the ends of an axis
LABELS: Mapping[str, str] = {  # of the claims' numbers, by claim
    "large-neighbourhoods": "$g_k$ as tuned / wide",
    "no-good-solution": "tuned for both / for each",
    "separate-maps": "two maps / one map",
    "widths-position": "position widths / reversed",
    "widths-orientation": "orientation widths / reversed",
    "cells-position": "position: supernet / subnets",
    "cells-orientation": "orientation: subnets / supernet",
    "theta-increments": "theta: increments / values",
    "jacobian-increments": "Jacobians: increments / values",
    "not-drastic": "drastic change / the paper's",
    "cooperation": "both: increments / values",
    "schedule": "equal visits / exponential",
    "local-units": "radial units: increments / values",
    "ritter-slow": "Ritter, equal cells",
    "figure-1": "improved",
    "rough-search": "improved, rough search",
}


class Row(NamedTuple):
    """A claim whose verdict depends on setups."""

    claim: OfSetups  # the claim
    finding: Finding  # the finding about it
    numbers: np.ndarray  # (setup,) its number in each setup

    @property
    def is_share(self) -> bool:
        """Whether its number is the remaining share of an error, not a ratio of errors."""
        return isinstance(self.claim.estimand, Remaining)

    @property
    def result(self) -> str:
        """The mean number and the verdict, as text."""
        value = self.finding.estimates[0].value
        number = f"{100 * value:.2g} %" if self.is_share else f"{value:.3g}"
        return f"{number} {self.finding.verdict}"


def rows(evidence: Evidence) -> list[Row]:
    """All claims whose verdicts depend on errors in setups, in the paper's order."""
    findings = evidence.findings()
    return [
        Row(claim, findings[claim.id], np.exp(claim.values(evidence).model().numbers))
        for claim in claims(evidence.study)
        if isinstance(claim, OfSetups)
        and not isinstance(claim.estimand, Crossing)
        and claim.id in findings
    ]


def contrasts(evidence: Evidence) -> Figure:
    """The number of each claim in all setups; top: ratios of errors, bottom: remaining shares."""
    shown = rows(evidence)
    parts = [[row for row in shown if row.is_share is share] for share in (False, True)]
    counts = [len(part) for part in parts]
    figure, panels = plt.subplots(
        2, 1, figsize=(WIDTH, ROW * sum(counts) + 0.9), height_ratios=counts
    )
    labels = "error ratio", "larger remaining share"
    for axes, part, label in zip(panels, parts, labels, strict=True):
        _draw(axes, part)
        axes.set_xlabel(label)
    panels[1].xaxis.set_major_formatter(PercentFormatter(1, decimals=0, symbol=" %"))
    return figure


def _draw(axes: Axes, part: list[Row]) -> None:
    heights = range(len(part) - 1, -1, -1)
    numbers = np.concatenate(
        [[*row.numbers, *(row.finding.estimates[0].predictive_interval or ())] for row in part]
    )
    low, high = numbers.min() / MARGIN, numbers.max() * MARGIN
    for height, row in zip(heights, part, strict=True):
        _draw_row(axes, height, row, (low, high))
    name_rows(axes, heights, [LABELS.get(row.claim.id, row.claim.name) for row in part])
    results = name_right(axes, heights, [row.result for row in part])
    for label, row in zip(results.get_yticklabels(), part, strict=True):
        if row.finding.verdict in (Verdict.SUPPORTED, Verdict.CONTRADICTED):
            label.set_fontweight("bold")
    ticks = TICKS if high < ROOM * low else DECADES
    logarithmic(axes.xaxis, *(tick for tick in ticks if low < tick < high))
    axes.set(xlim=(low, high), ylim=(-0.5, len(part) - 0.5))


def _draw_row(axes: Axes, height: float, row: Row, ends: tuple[float, float]) -> None:
    comparison, number = row.claim.comparison, row.finding.estimates[0]
    limit = np.exp(comparison.limit)
    side = (ends[0], limit) if comparison.below else (limit, ends[1])
    around = height - 0.47, height + 0.47
    axes.fill_between(side, *around, color=HOLDS, alpha=0.2, linewidth=0)
    axes.vlines(limit, *around, **BORDER)
    if comparison.same:
        same = np.exp([comparison.limit - comparison.same, comparison.limit + comparison.same])
        axes.vlines(same, *around, linestyle=(0, (1, 1)), **BORDER)
    upper = height + 0.14 + spread(len(row.numbers))
    axes.scatter(row.numbers, upper, s=12, marker=".", color="0.35", lw=0)
    lower = height - 0.26
    axes.hlines(lower, *(number.predictive_interval or ()), color=NEUTRAL, linewidth=0.8)
    axes.hlines(lower, *(number.interval or ()), color=NEUTRAL, linewidth=3)
    axes.scatter(number.value, lower, s=0.8 * MARK, marker="D", color=NEUTRAL, zorder=3)
