"""Figures that answer what one should use today."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from recalib.study.evidence.results import Evidence
from recalib.study.plots.style import LABELS, plain, title

# Colours of Okabe and Ito and a marker each, for black and white.
ENTRANTS = {
    "uncorrected": ("0.5", ""),
    "affine": ("#CC79A7", "v"),
    "quadratic": ("#E69F00", "^"),
    "gaussian_process": ("#009E73", "D"),
    "geometric": ("#56B4E9", "s"),
    "hybrid": ("#000000", "*"),
    "improved": ("#0072B2", "o"),
    "ritter": ("#D55E00", "P"),
}
SHOWN = {
    "links_encoders": "the paper's damage",
    "noise": "... measured with noise",
    "outliers": "... with 10 % outliers of 5 cm",
    "links_encoders_gears_sag": "... with eccentric gears and sag",
}
PUBLISHED = (
    0.1549  # mm, mean over the test poses of the recording, after a calibration from all of it
)
SMALLEST = 1e-4  # cm and degrees: below it, errors are drawn at the edge


def figure12(evidence: Evidence) -> Figure:
    """Errors against moves for every learner on four of the benchmark's scenarios."""
    table = pd.read_csv(evidence.results / "benchmark.csv")
    figure, panels = plt.subplots(2, len(SHOWN), figsize=(13, 6.4), sharex=True, sharey="row")
    for column, (scenario, name) in zip(panels.T, SHOWN.items(), strict=True):
        column[0].set_title(name, fontsize=11)
        for axes, (error, label) in zip(column, LABELS.items(), strict=True):
            for learner, (color, marker) in ENTRANTS.items():
                own = table[(table["scenario"] == scenario) & (table["learner"] == learner)]
                style = {"color": color, "linewidth": 1.4}
                axes.fill_between(
                    own["moves"],
                    own[f"{error}_low"].clip(SMALLEST),
                    own[f"{error}_high"].clip(SMALLEST),
                    color=color,
                    alpha=0.2,
                    linewidth=0,
                )
                axes.plot(
                    own["moves"],
                    own[error].clip(SMALLEST),
                    marker=marker or None,
                    markersize=4,
                    label=learner,
                    **style,
                )
            axes.set(xscale="log", yscale="log", ylim=(SMALLEST, 30))
            if axes in panels[:, 0]:
                axes.set_ylabel(label)
    for axes in panels[-1]:
        axes.set_xlabel("robot moves")
    names = [name.replace("_", " ") for name in ENTRANTS]
    figure.legend(panels[0, 0].get_lines(), names, loc="outside right center", fontsize=9)
    seeds = evidence.config["benchmark"]["seeds"]
    title(
        figure,
        "Figure 12: what should one use today? A model of the arm needs a handful of moves, the maps of 1996 hundreds",
        f"means over {seeds} seeds; bands: 95 % bootstrap intervals; errors below {SMALLEST:g} are drawn there",
    )
    return figure


def figure13(evidence: Evidence) -> Figure:
    """The real UR5: errors on the test poses against the number of recorded poses."""
    table = pd.read_csv(evidence.results / "real.csv")
    figure, axes = plt.subplots(figsize=(9, 4.6))
    for learner, own in table.groupby("learner", sort=False):
        color, marker = ENTRANTS[learner.split()[0]]
        linestyle = (0, (4, 2)) if " on a twin" in learner else "-"
        bounds = own["position_error_mm_low"], own["position_error_mm_high"]
        axes.fill_between(own["poses"], *bounds, color=color, alpha=0.2, linewidth=0)
        name = learner.replace("_", " ")
        axes.plot(
            own["poses"],
            own["position_error_mm"],
            color=color,
            marker=marker or None,
            linestyle=linestyle,
            label=name,
        )
    axes.axhline(PUBLISHED, color="0.4", linewidth=0.8)
    axes.annotate(
        f"published: {PUBLISHED} mm",
        (3000, PUBLISHED),
        (0, -12),
        textcoords="offset points",
        fontsize=9,
    )
    hybrid = table[table["learner"] == "hybrid"]
    enough = hybrid.loc[hybrid["position_error_mm"] < PUBLISHED, "poses"].min()
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="recorded poses (moves on the twin)",
        ylabel="mean position error, test poses [mm]",
    )
    plain(axes.xaxis, 5, 10, 20, 50, 100, 200, 500, 1000, 20_000)
    plain(axes.yaxis, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
    axes.tick_params(axis="x", labelsize=9)
    figure.legend(loc="outside right center", fontsize=9)
    title(
        figure,
        f"Figure 13: a real UR5, identified from {enough} poses, beats the published error",
        "means over random subsets of the 1,000 recorded poses, on 20 others; bands: 95 % bootstrap intervals",
    )
    return figure
