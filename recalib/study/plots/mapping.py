"""Figures of what the paper says about the damage and the mapping, before any learning."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from recalib.study.evidence.claims import expected_learning, weak_coupling
from recalib.study.evidence.results import Evidence
from recalib.study.mapping.propagation import integral_ratios
from recalib.study.measured import ERRORS, KINDS
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import BORDER, ORIENTATION, POSITION, plain, title, words


def figure5(evidence: Evidence) -> Figure:
    """The off-diagonal blocks of the true mapping's Jacobian."""
    figure, axes = plt.subplots(figsize=(8, 4))
    table, scenarios = evidence.mapping("coupling"), evidence.fact("scenarios")
    limit = weak_coupling.CLAIM.limits["ratio"]
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
    axes.annotate(
        "criterion",
        (limit, rows[0] + 0.4),
        (-4, 0),
        textcoords="offset points",
        ha="right",
        fontsize=9,
    )
    axes.set(xlabel="norm of the off-diagonal block over that of the diagonal block")
    widest = max(table.groupby("scenario")[kind].quantile(0.95).max() for kind in KINDS)
    axes.set_xlim(-0.03 * limit, 1.2 * max(limit, widest))
    axes.set_yticks(rows, [words(scenario) for scenario in scenarios])
    axes.grid(axis="y", visible=False)
    axes.legend(fontsize=9, loc="center right")
    poses = len(table) // table["scenario"].nunique()
    title(
        figure,
        "Figure 5: how much positions influence orientation commands, and the reverse",
        f"signs: medians over {poses} poses; lines: 5-95 % of them",
    )
    return figure


def figure7(evidence: Evidence) -> Figure:
    """E_upd over E_clas on the true mappings, from slight to drastic damage."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    ratio = integral_ratios(evidence.mapping("propagation"))
    for (kind, start), values in ratio.groupby(level=["kind", "start"]):
        style = POSITION if kind == "theta" else ORIENTATION
        axes.plot(
            values.index.get_level_values("scale"),
            values,
            color=style["color"],
            linestyle="-" if start == "intact" else (0, (4, 2)),
            marker="o" if kind == "theta" else "s",
            markersize=5,
            label=f"{'commands' if kind == 'theta' else 'Jacobians'}, from the {start} robot",
        )
    axes.axhline(1, **BORDER)
    axes.annotate(
        "above: a constant would be the better guess",
        (0.11, 1),
        (0, 4),
        textcoords="offset points",
        fontsize=9,
    )
    axes.set(
        xscale=LOG,
        yscale=LOG,
        xlabel="encoder shifts, times the paper's (links at most once)",
        ylabel="$E_{upd} / E_{clas}$",
        ylim=(None, 3),
    )
    plain(axes.xaxis, 0.1, 0.3, 1, 3, 10)
    axes.legend(fontsize=9, loc="lower right")
    title(
        figure,
        "Figure 7: which is the better guess, the old mapping or a constant?",
        f"medians over {evidence.fact('balls')} balls of radius {evidence.fact('radius'):g} in"
        " workspace coordinates; Jacobians from the intact robot: both integrals are the same",
    )
    return figure


def figure8(evidence: Evidence) -> Figure:
    """Monte Carlo of the expected learning beside (10)."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    table = evidence.mapping("visits")
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
    axes.axvline(away, **BORDER)
    axes.set(
        xlabel="distance of the cell to the border, in widths",
        ylabel="simulated expected learning / (10)",
        xlim=(-0.1, 6.2),
        ylim=(0, 1.15),
    )
    axes.legend(fontsize=9)
    title(
        figure,
        "Figure 8: equation (10), from the border of the workspace inwards",
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
        label=f"{len(table):,} assignments",
        rasterized=True,
    )
    nearest = evidence.nearest_assignment()
    axes.scatter(
        *(nearest[error] for error in ERRORS),
        s=70,
        color=POSITION["color"],
        label="the one used",
        zorder=3,
    )
    axes.scatter(
        *(published[error] for error in ERRORS),
        s=120,
        marker="+",
        linewidths=2,
        color=ORIENTATION["color"],
        label="published",
        zorder=4,
    )
    axes.set(
        xlabel="initial position error [cm]",
        ylabel="initial orientation error [degrees]",
        xlim=(0, None),
        ylim=(0, None),
    )
    axes.legend(fontsize=9)
    title(
        figure,
        "Figure 10: the initial errors of every assignment of the paper's damage",
        f"means over {evidence.fact('assignment_poses')} random poses",
    )
    return figure
