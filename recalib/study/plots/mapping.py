"""Figures of what the paper says about the damage and the mapping, before any learning."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from recalib.study.evidence.claims import coupling, expected_learning
from recalib.study.evidence.claims.reasons import integral_ratios
from recalib.study.evidence.results import Evidence
from recalib.study.measured import ERRORS, KINDS
from recalib.study.plots.looks import DASHED
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import (
    BORDER,
    NEUTRAL,
    ORIENTATION,
    POSITION,
    at_line,
    legend_below,
    plain,
    title,
    words,
)


def figure5(evidence: Evidence) -> Figure:
    """The off-diagonal blocks of the true mapping's Jacobian."""
    figure, axes = plt.subplots(figsize=(8, 4))
    table, scenarios = evidence.table("mapping/coupling.parquet"), evidence.fact("scenarios")
    limit = coupling.CLAIM.limits["ratio"]
    rows = np.arange(len(scenarios))[::-1]
    styles = zip((0.15, -0.15), KINDS, (POSITION, ORIENTATION), "os", strict=True)
    for offset, kind, style, marker in styles:
        quantiles = table.groupby("scenario")[kind].quantile([0.05, 0.5, 0.95]).unstack()
        quantiles = quantiles.loc[scenarios]
        axes.hlines(rows + offset, quantiles[0.05], quantiles[0.95], color=style["color"])
        axes.scatter(
            quantiles[0.5],
            rows + offset,
            color=style["color"],
            marker=marker,
            label=f"{kind} commands",
            zorder=3,
        )
    axes.axvline(limit, **BORDER)
    at_line(axes, f"criterion: below {limit:g}", x=limit)
    axes.set(xlabel="norm of the off-diagonal block over that of the diagonal block")
    widest = max(table.groupby("scenario")[kind].quantile(0.95).max() for kind in KINDS)
    axes.set_xlim(-0.03 * limit, 1.2 * max(limit, widest))
    axes.set_yticks(rows, [words(scenario) for scenario in scenarios])
    axes.grid(axis="y", visible=False)
    poses = len(table) // table["scenario"].nunique()
    title(figure, "Figure 5: how much positions influence orientation commands, and the reverse")
    legend_below(figure, axes, 2, f"signs: medians over {poses} poses; lines: 5-95 % of them")
    return figure


def figure7(evidence: Evidence) -> Figure:
    """E_upd over E_clas on the true mappings, from slight to large damage."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    ratio = integral_ratios(evidence.table("mapping/propagation.parquet"))
    for (kind, start), values in ratio.groupby(level=["kind", "start"]):
        commands, intact = kind == "theta", start == "intact"
        axes.plot(
            values.index.get_level_values("scale"),
            values,
            color=NEUTRAL if commands else "0.55",
            linestyle="-" if intact else DASHED,
            linewidth=1.5 if commands == intact else 3,  # two of them lie upon another
            marker="o" if commands else "s",
            markersize=5,
            label=f"{'commands' if kind == 'theta' else 'Jacobians'}, from the {start} robot",
        )
    axes.axhline(1, **BORDER)
    at_line(axes, "above: a constant would be the better guess", y=1)
    axes.set(
        xscale=LOG,
        yscale=LOG,
        xlabel="encoder shifts, times the paper's (links at most once)",
        ylabel="$E_{upd} / E_{clas}$",
        ylim=(None, 3),
    )
    plain(axes.xaxis, 0.1, 0.3, 1, 3, 10)
    plain(axes.yaxis, 0.0001, 0.001, 0.01, 0.1, 1)
    largest = ratio.dropna().index.get_level_values("scale").max()
    kept = (ratio["theta"].dropna() < 1).all()
    title(
        figure,
        "Figure 7: the old mapping of commands is a better guess than a constant"
        + (f",\nup to {largest:g} times the paper's damage" if kept else " in slight damage"),
    )
    legend_below(
        figure,
        axes,
        2,
        f"medians over {evidence.fact('balls')} balls of radius {evidence.fact('radius'):g} in"
        " workspace coordinates; Jacobians from the intact robot: both\nintegrals are the same."
        f" Damage beyond {largest:g} times the paper's takes poses out of reach",
    )
    return figure


def figure8(evidence: Evidence) -> Figure:
    """Monte Carlo of the expected learning beside (10)."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    table = evidence.table("mapping/visits.parquet")
    shades = plt.get_cmap("viridis")(np.linspace(0, 0.85, table["width"].nunique()))
    for shade, (width, rows), marker in zip(shades, table.groupby("width"), "os^Dv*", strict=False):
        axes.errorbar(
            rows["distance"] / width,
            rows["ratio"],
            2 * rows["error"],
            color=shade,
            marker=marker,
            markersize=5,
            label=f"width {width:g}",
        )
    axes.axhline(1, **BORDER)
    at_line(axes, "equation (10)", y=1, until=0.65)
    away = expected_learning.CLAIM.limits["away"]
    axes.axvline(away, **BORDER)
    at_line(axes, f"criterion: from {away:g} on", x=away)
    axes.set(
        xlabel="distance of the cell to the border, in widths",
        ylabel="simulated expected learning / (10)",
        xlim=(-0.1, 6.2),
        ylim=(0, 1.15),
    )
    title(figure, "Figure 8: equation (10), from the border of the workspace inwards")
    legend_below(
        figure,
        axes,
        table["width"].nunique(),
        "bars: two standard errors of the simulation; the workspace is 2 wide, so that no cell is"
        f" {away:word} large widths away",
    )
    return figure


def figure10(evidence: Evidence) -> Figure:
    """The initial errors of every assignment of the paper's damage."""
    figure, axes = plt.subplots(figsize=(8, 5))
    table, published = evidence.assignments(), evidence.fact("published")
    axes.scatter(
        *(table[error] for error in ERRORS),
        s=5,
        alpha=0.35,
        color="0.5",
        linewidths=0,
        rasterized=True,
    )
    axes.scatter([], [], s=25, color="0.5", label=f"{len(table):,} assignments")
    nearest = evidence.nearest_assignment()
    axes.scatter(
        *(nearest[error] for error in ERRORS),
        s=90,
        facecolors="none",
        edgecolors=NEUTRAL,
        linewidths=2,
        label="the one used",
        zorder=3,
    )
    axes.scatter(
        *(published[error] for error in ERRORS),
        s=120,
        marker="+",
        linewidths=2,
        color=NEUTRAL,
        label="published",
        zorder=4,
    )
    axes.set(
        xlabel="initial position error [cm]",
        ylabel="initial orientation error [degrees]",
        xlim=(0, None),
        ylim=(0, None),
    )
    title(figure, "Figure 10: the initial errors of every assignment of the paper's damage")
    legend_below(figure, axes, 3, f"means over {evidence.fact('assignment_poses')} random poses")
    return figure
