"""Figures of what the paper says about the damage and the mapping, before any learning."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from recalib.study.evidence.results import ERRORS, Evidence
from recalib.study.mapping.propagation import integral_ratios
from recalib.study.plots.style import ORIENTATION, POSITION, plain, title


def figure5(evidence: Evidence) -> Figure:
    """The off-diagonal blocks of the true mapping's Jacobian."""
    figure, axes = plt.subplots(figsize=(8, 4))
    table = evidence.study("coupling")
    rows = np.arange(len(evidence.scenarios))[::-1]
    for offset, (column, style, marker) in zip(
        (0.15, -0.15), (("position", POSITION, "o"), ("orientation", ORIENTATION, "s")), strict=True
    ):
        quantiles = (
            table.groupby("scenario")[column]
            .quantile([0.05, 0.5, 0.95])
            .unstack()
            .loc[evidence.scenarios]
        )
        axes.hlines(rows + offset, quantiles[0.05], quantiles[0.95], color=style["color"])
        axes.scatter(
            quantiles[0.5],
            rows + offset,
            color=style["color"],
            marker=marker,
            label=f"{column} commands",
            zorder=3,
        )
    axes.axvline(0.1, color="0.4", linewidth=0.8)
    axes.annotate(
        "criterion",
        (0.1, rows[0] + 0.4),
        (-4, 0),
        textcoords="offset points",
        ha="right",
        fontsize=9,
    )
    axes.set(
        xlabel="norm of the off-diagonal block over that of the diagonal block", xlim=(-0.003, 0.12)
    )
    axes.set_yticks(rows, [scenario.replace("_", " and ") for scenario in evidence.scenarios])
    axes.grid(axis="y", visible=False)
    axes.legend(fontsize=9, loc="center right")
    title(
        figure,
        "Figure 5: positions hardly influence orientation commands, and the reverse",
        f"signs: medians over {len(table) // table['scenario'].nunique()} poses; lines: 5-95 % of them",
    )
    return figure


def figure7(evidence: Evidence) -> Figure:
    """E_upd over E_clas on the true mappings, from slight to drastic damage."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    ratio = integral_ratios(evidence.study("propagation"))
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
    axes.axhline(1, color="0.4", linewidth=0.8)
    axes.annotate(
        "above: a constant would be the better guess",
        (0.11, 1),
        (0, 4),
        textcoords="offset points",
        fontsize=9,
    )
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="encoder shifts, times the paper's (links at most once)",
        ylabel="$E_{upd} / E_{clas}$",
        ylim=(None, 3),
    )
    plain(axes.xaxis, 0.1, 0.3, 1, 3, 10)
    axes.legend(fontsize=9, loc="lower right")
    plan = evidence.config["studies"]
    title(
        figure,
        "Figure 7: the old mapping is the better guess unless the damage is drastic",
        f"medians over {plan['balls']} balls of radius {plan['radius']:g} in workspace coordinates; "
        "Jacobians from the intact robot: both integrals are the same",
    )
    return figure


def figure8(evidence: Evidence) -> Figure:
    """Monte Carlo of the expected learning beside (10)."""
    figure, axes = plt.subplots(figsize=(8, 4.2))
    table = evidence.study("visits")
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
    axes.axhline(1, color="0.4", linewidth=0.8)
    axes.axvline(3, color="0.4", linewidth=0.8)
    axes.set(
        xlabel="distance of the cell to the border, in widths",
        ylabel="simulated expected learning / (10)",
        xlim=(-0.1, 6.2),
        ylim=(0, 1.15),
    )
    axes.legend(fontsize=9)
    title(
        figure,
        "Figure 8: equation (10) holds three widths away from the border",
        "bars: two standard errors of the simulation; the workspace is 2 wide, so that no cell is three large widths away",
    )
    return figure


def figure10(evidence: Evidence) -> Figure:
    """The initial errors of every assignment of the paper's damage."""
    figure, axes = plt.subplots(figsize=(8, 5))
    table = evidence.assignments()
    axes.scatter(
        table[ERRORS[0]],
        table[ERRORS[1]],
        s=5,
        alpha=0.35,
        color="0.5",
        linewidths=0,
        label=f"{len(table):,} assignments",
        rasterized=True,
    )
    nearest = table.loc[table["distance"].idxmin()]
    axes.scatter(
        nearest[ERRORS[0]],
        nearest[ERRORS[1]],
        s=70,
        color="#0072B2",
        label="the one used",
        zorder=3,
    )
    axes.scatter(
        *evidence.published.values(),
        s=120,
        marker="+",
        linewidths=2,
        color="#D55E00",
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
        "Figure 10: the published initial errors are ordinary ones for this damage",
        f"means over {evidence.config['paper_damage']['poses']} random poses",
    )
    return figure
