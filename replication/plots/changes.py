"""The figure of the four changes, and of learners beside them."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.config.shipped import REFERENCE
from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.judgement.claims.changes import compare, with_and_without
from replication.judgement.claims.maps import SEPARATE
from replication.judgement.intervals import Estimate
from replication.judgement.results import Evidence
from replication.plots.palette import Style, styles_of
from replication.plots.style import (
    INTERVALS,
    finish,
    line_across,
    logarithmic,
    name_rows,
    note,
    with_intervals,
)

MAPS, OTHERS = SWITCHES[0], SWITCHES[1:]
NESTED = "maps_improved", "maps_ritter"  # columns of the reference study's replicates
ANOTHER = ",\nanother learner"


def _rows(evidence: Evidence) -> dict[str, list[Estimate]]:
    """For each row its label, and what it does to the improved system and to Ritter's."""
    rows, own = {}, evidence.facts["switched"]
    if own and REFERENCE in evidence.files:
        measured = {across.column: across for across in SEPARATE.across.values()}
        reference = evidence.table(REFERENCE)
        rows[MAPS.label] = [measured[column].in_reference(reference) for column in NESTED]
    for switch in OTHERS if own else ():
        pairs = with_and_without(evidence, switch).values()
        rows[switch.label] = [compare(evidence, *pair) for pair in pairs]
    for learner, style in styles_of(evidence.facts["beside"]).items():
        others = evidence.facts["improved"], evidence.facts["short"]
        rows[f"{style.label}{ANOTHER}"] = [compare(evidence, learner, other) for other in others]
    return rows


def _draw(
    axes: Axes, heights: np.ndarray, ratios: list[Estimate], style: Style, label: str, above: bool
) -> None:
    means, *ends = np.transpose(ratios)
    with_intervals(axes, heights, means, ends, label, style)
    for height, mean in zip(heights, means, strict=True):
        note(
            axes,
            f"{mean:.2f}",
            (mean, height),
            (0, 5 if above else -6),
            ha="center",
            va="bottom" if above else "top",
            fontsize=9,
            color=style.color,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.4},  # on a line, too
        )


def _heading(rows: dict[str, list[Estimate]]) -> str:
    changes = [switch.label for switch in SWITCHES if switch.label in rows]
    if not changes:
        return f"Figure 4: other learners ({len(rows)}) compared with the paper's two"
    most = min(changes, key=lambda label: max(ratio.mean for ratio in rows[label]))
    weakest = max(ratio.mean for ratio in rows[most])
    if weakest >= 1:
        return f"Figure 4: none of the paper's changes ({len(changes)}) helps both systems"
    return f"Figure 4: of the paper's changes, {most} help most: error x {weakest:.2f} or less"


def figure4(evidence: Evidence) -> Figure:
    """The four changes, each taken from the improved system and added to Ritter's.

    Learners beside them have a row of their own: their error over that of either.
    """
    rows = _rows(evidence)
    figure, axes = plt.subplots(figsize=(8, 1.5 + 0.9 * len(rows)))
    heights = np.arange(len(rows))[::-1]
    shown = styles_of([IMPROVED, RITTER])
    cases = (
        (IMPROVED, 0.12, "improved with it / without it"),
        (RITTER, -0.12, "Ritter with it / without it"),
    )
    for case, (learner, offset, label) in enumerate(cases):
        ratios = [estimates[case] for estimates in rows.values()]
        _draw(axes, heights + offset, ratios, shown[learner], label, above=offset > 0)
    line_across(axes, "left of it: the change helps", x=1)
    axes.set_xlabel("error with the change over error without it")
    if evidence.facts["beside"]:
        axes.set_xlabel(
            "error with the change over error without it;\n"
            "rows of other learners: their error over that of the improved system, and of Ritter's"
        )
    logarithmic(axes.xaxis, 0.05, 0.1, 0.2, 0.5, 1, 2, 5)
    name_rows(axes, heights, rows)
    axes.set_ylim(-0.5, len(rows) - 0.3)
    searches, seeds, _ = evidence.errors(evidence.facts["improved"]).shape
    how = ""
    if MAPS.label in rows:
        how = (
            f"\n{MAPS.label}: both searches go on from one winner;"
            f" {len(evidence.table(REFERENCE))} replicates, 95 % interval of their mean"
        )
    finish(
        figure,
        _heading(rows),
        axes,
        len(cases),
        f"geometric mean of both errors after {evidence.facts['iterations']} iterations;"
        f" {searches} searches each, {seeds} seeds for each winner\n{INTERVALS}{how}",
    )
    return figure
