"""Figures of what the paper says about the damage and the mapping, before any learning."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from replication.judgement.claims import coupling, expected_learning
from replication.judgement.claims.reasons import integral_ratios
from replication.judgement.results import Evidence
from replication.pages.words import percent
from replication.plots.palette import BORDER, BOTH, DASHED, NEUTRAL
from replication.plots.style import (
    finish,
    line_across,
    logarithmic,
    name_rows,
    with_intervals,
    words,
)
from replication.training.measured import ERRORS, KINDS, UNITS


def figure5(evidence: Evidence) -> Figure:
    """The off-diagonal blocks of the true mapping's Jacobian."""
    figure, axes = plt.subplots(figsize=(8, 4))
    table, scenarios = evidence.table("mapping/coupling.parquet"), evidence.facts["scenarios"]
    limit = coupling.CLAIM.limits["ratio"]
    rows = np.arange(len(scenarios))[::-1]
    for offset, error in zip((0.15, -0.15), BOTH, strict=True):
        quantiles = table.groupby("scenario")[error.kind].quantile([0.05, 0.5, 0.95]).unstack()
        low, middle, high = quantiles.loc[scenarios].to_numpy().T
        name = f"{error.kind} commands"
        with_intervals(axes, rows + offset, middle, (low, high), name, error)
    line_across(axes, f"criterion: below {limit:g}", x=limit)
    axes.set(xlabel="norm of the off-diagonal block over that of the diagonal block")
    widest = max(table.groupby("scenario")[kind].quantile(0.95).max() for kind in KINDS)
    axes.set_xlim(-0.03 * limit, 1.2 * max(limit, widest))
    name_rows(axes, rows, map(words, scenarios))
    poses = len(table) // table["scenario"].nunique()
    text = (
        "Figure 5: in 95 % of poses, positions and orientations change"
        f"\neach other's commands by at most {percent(widest)} of what they change their own"
    )
    finish(figure, text, axes, 2, f"signs: medians over {poses} poses; lines: 5-95 % of them")
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
            linewidth=1.5 if commands == intact else 3,  # two of them lie upon others
            marker="o" if commands else "s",
            markersize=5 if commands == intact else 10,
            fillstyle="full" if commands == intact else "none",
            label=f"{'commands' if kind == 'theta' else 'Jacobians'}, from the {start} robot",
        )
    axes.axhline(1, **BORDER)
    axes.text(0.1, 2.5, "above the line a constant is the better guess", fontsize=9, color="0.4")
    axes.set_xlabel("encoder shifts, times the paper's (links at most once)")
    axes.set_ylabel("E_upd / E_clas")
    logarithmic(axes.xaxis, 0.1, 0.3, 1, 3, 10)
    logarithmic(axes.yaxis, 0.0001, 0.001, 0.01, 0.1, 1)
    axes.set_ylim(top=10)
    largest = ratio.dropna().index.get_level_values("scale").max()
    better = (ratio["theta"].dropna() < 1).all()
    finish(
        figure,
        "Figure 7: the old mapping of commands is a better guess than a constant"
        + (f",\nup to {largest:g} times the paper's damage" if better else " in slight damage"),
        axes,
        2,
        "E_clas: mean square distance of the new mapping from a constant;"
        " E_upd: from the old mapping plus a constant\n"
        f"medians over {evidence.facts['balls']} balls of radius {evidence.facts['radius']:g} in"
        " workspace coordinates; Jacobians from the intact robot:\nboth are the same;"
        f" beyond {largest:g} times the paper's damage, poses are out of reach",
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
    away = expected_learning.CLAIM.limits["away"]
    line_across(axes, f"criterion: from {away:g} on", x=away)
    widths = table["distance"] / table["width"]
    off = (table.loc[widths >= away, "ratio"] - 1).abs().max()
    border = table.loc[table["distance"] == 0, "ratio"]
    axes.set(
        xlabel="distance of the cell to the border, in widths",
        ylabel="simulated learning / equation (10)",
        xlim=(-0.1, 6.2),
        ylim=(0, 1.15),
    )
    finish(
        figure,
        f"Figure 8: equation (10) holds within {percent(off)} from {away:word} widths on;\n"
        f"at the border a cell learns {percent(border.min())} to {percent(border.max())} of it",
        axes,
        table["width"].nunique(),
        "bars: two standard errors of the simulation; the workspace is 2 wide, so that no cell is"
        f" {away:word} large widths away",
    )
    return figure


def figure10(evidence: Evidence) -> Figure:
    """The initial errors of every assignment of the paper's damage."""
    figure, axes = plt.subplots(figsize=(8, 5))
    table, published = evidence.assignments(), evidence.facts["published"]
    position, orientation = ERRORS
    axes.scatter(
        table[position],
        table[orientation],
        s=5,
        alpha=0.35,
        color="0.5",
        linewidths=0,
        rasterized=True,
    )
    axes.scatter([], [], s=25, color="0.5", label=f"{len(table):,} assignments")
    nearest = evidence.nearest_assignment()
    axes.scatter(
        nearest[position],
        nearest[orientation],
        s=90,
        facecolors="none",
        edgecolors=NEUTRAL,
        linewidths=2,
        label="the one used",
        zorder=3,
    )
    axes.scatter(
        published[position],
        published[orientation],
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
    off = (np.ceil(100 * abs(nearest[error] - published[error])) / 100 for error in ERRORS)
    within = " and ".join(f"{most:g} {unit}" for most, unit in zip(off, UNITS, strict=True))
    text = f"Figure 10: one of {len(table):,} assignments has the published errors\nwithin {within}"
    finish(figure, text, axes, 3, f"means over {evidence.facts['assignment_poses']} random poses")
    return figure
