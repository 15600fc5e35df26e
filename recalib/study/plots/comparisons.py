"""Figures that compare learners: the four changes, the search, the speed-up, other damages and other robots."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.evidence.claims import combined
from recalib.study.evidence.results import ERRORS, Evidence
from recalib.study.evidence.speedup import speed_up
from recalib.study.experiments import search
from recalib.study.plots.style import LABELS, LEARNERS, ORIENTATION, POSITION, plain, title
from recalib.study.statistics import paired_ratio

SWITCHES = {
    "separate maps": ("improved_single_map", "ritter_separate_maps"),
    "increments of theta": ("improved_theta_values", "ritter_theta_increments"),
    "increments of the Jacobians": ("improved_jacobian_values", "ritter_jacobian_increments"),
    "schedule of equal visits": ("improved_exponential", "ritter_equal_visits"),
}
INTERVALS = "lines: 95 % bootstrap intervals"


def _seeds(evidence: Evidence) -> int:
    return len(evidence.errors("improved"))


def figure4(evidence: Evidence) -> Figure:
    """The four changes, each taken away from the improved system and added to Ritter's."""
    figure, axes = plt.subplots(figsize=(8, 3.6))
    rows = np.arange(len(SWITCHES))[::-1]
    cases = (
        ("improved with it / without it", 0.12, "#0072B2", "o"),
        ("Ritter with it / without it", -0.12, "#D55E00", "s"),
    )
    for case, (label, offset, color, marker) in enumerate(cases):
        pairs = [
            ("improved", names[0]) if case == 0 else (names[1], "ritter_200")
            for names in SWITCHES.values()
        ]
        ratios = [
            paired_ratio(*(combined(evidence.errors(each)) for each in pair), evidence.rng(*pair))
            for pair in pairs
        ]
        means, low, high = np.transpose(ratios)
        axes.hlines(rows + offset, low, high, color=color)
        axes.scatter(means, rows + offset, color=color, marker=marker, label=label, zorder=3)
        for row, mean in zip(rows + offset, means, strict=True):
            axes.annotate(
                f"{mean:.2f}",
                (mean, row),
                (0, 6),
                textcoords="offset points",
                ha="center",
                fontsize=9,
                color=color,
            )
    axes.axvline(1, color="0.4", linewidth=0.8)
    axes.set(xscale="log", xlabel="error with the change over error without it")
    plain(axes.xaxis, 0.05, 0.1, 0.2, 0.5, 1)
    axes.set_yticks(rows, SWITCHES)
    axes.set_ylim(-0.5, len(SWITCHES) - 0.3)
    axes.grid(axis="y", visible=False)
    axes.legend(fontsize=9)
    title(
        figure,
        "Figure 4: of the four changes, propagating increments of theta makes the difference",
        f"mean of both errors after 200 iterations, {_seeds(evidence)} paired seeds, same budget for each; {INTERVALS}",
    )
    return figure


def figure6(evidence: Evidence) -> Figure:
    """What the search for the improved system found: how good, and which order of widths."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.4))
    for learner, training in (("improved", "improved_200"), ("ritter", "ritter_10000")):
        trials = evidence.trials(training)
        ratio = np.sort(search.score(trials[trials["round"] == 1])) / search.score(trials).min()
        style = LEARNERS[learner]
        panels[0].step(
            ratio,
            np.arange(1, len(ratio) + 1) / len(ratio),
            color=style["color"],
            linestyle=style["linestyle"],
            label=style["label"],
        )
    panels[0].axvline(2, color="0.4", linewidth=0.8)
    panels[0].set(
        xscale="log",
        xlabel="worse error of a random trial over that of the best trial",
        ylabel="share of the first round's trials",
    )
    plain(panels[0].xaxis, 1, 2, 5, 10, 20, 50, 100)
    panels[0].set_title("How rough may the search be?", fontsize=11)
    panels[0].legend(fontsize=9)
    trials = evidence.trials("improved_200")
    for name, style, marker in (("position", POSITION, "o"), ("orientation", ORIENTATION, "s")):
        panels[1].scatter(
            trials[f"{name}/g_k"] / trials[f"{name}/g_kl"],
            search.score(trials),
            s=14,
            alpha=0.6,
            color=style["color"],
            marker=marker,
            label=f"{name} map",
        )
    panels[1].axvline(1, color="0.4", linewidth=0.8)
    panels[1].set(
        xscale="log",
        yscale="log",
        xlabel="final width of $g_k$ (positions) over that of $g_{kl}$ (orientations)",
        ylabel="worse error [cm or degrees]",
    )
    plain(panels[1].xaxis, 0.1, 0.3, 1, 3, 10)
    plain(panels[1].yaxis, 0.3, 0.5, 1, 2, 5)
    panels[1].set_title("Which widths does each map want?", fontsize=11)
    panels[1].legend(fontsize=9, loc="center left", frameon=True, framealpha=0.9, edgecolor="none")
    title(
        figure,
        "Figure 6: what the search sees",
        f"{len(trials)} trials for each training, 2 seeds each, improved at 200 iterations on the right",
    )
    return figure


def figure9(evidence: Evidence) -> Figure:
    """The ladders of iterations and the speed-up over error levels."""
    figure, panels = plt.subplots(1, 3, figsize=(12, 4.4))
    ladders = {name: evidence.ladder(name) for name in ("improved", "ritter")}
    for name, ladder in ladders.items():
        style = LEARNERS[name]
        means = np.array([errors.mean(axis=0) for errors in ladder.values()])
        for axes, kind in ((panels[0], 0), (panels[1], 1)):
            axes.plot(
                list(ladder),
                means[:, kind],
                color=style["color"],
                linestyle=style["linestyle"],
                marker=style["marker"],
                label=name.capitalize(),
            )
    for axes, label in zip(panels[:2], LABELS.values(), strict=True):
        axes.set(
            xscale="log", yscale="log", xlabel="iterations, tuned for each number", ylabel=label
        )
        plain(axes.xaxis, 100, 1000, 10_000)
        plain(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 4)
    panels[0].legend(fontsize=9)
    _draw_factors(panels[2], evidence, ladders)
    title(
        figure,
        "Figure 9: how many times as many iterations does Ritter's map need?",
        f"means over {_seeds(evidence)} seeds, {len(evidence.errors('ritter'))} for long trainings; {INTERVALS}",
    )
    return figure


def _draw_factors(axes: Axes, evidence: Evidence, ladders: dict) -> None:
    initial = evidence.errors("improved", moment="first").mean(axis=0)
    for level in (0.3, 0.2, 0.15, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03):
        factor = speed_up(
            ladders["ritter"],
            ladders["improved"],
            level * initial,
            evidence.rng("level", str(level)),
        )
        if np.isfinite(factor.mean):
            high = factor.high if np.isfinite(factor.high) else 1000
            axes.vlines(100 * level, factor.low, high, color="#0072B2")
            axes.scatter(100 * level, factor.mean, color="#0072B2", zorder=3)
    ours = speed_up(ladders["ritter"], ladders["improved"], 200, evidence.rng("speed-up"))
    reached = (ladders["improved"][200].mean(axis=0) / initial).max()
    axes.scatter(
        100 * reached,
        ours.mean,
        s=120,
        marker="*",
        color="black",
        zorder=4,
        label=f"after 200 iterations: {ours.mean:.0f}",
    )
    axes.axhline(70, color="#D55E00", linestyle=(0, (5, 2)), label="the paper: about 70")
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="both errors within [% of the initial ones]",
        ylabel="Ritter's iterations / improved",
        ylim=(1, 300),
    )
    plain(axes.xaxis, 3, 5, 10, 20, 30)
    plain(axes.yaxis, 1, 3, 10, 30, 100, 300)
    axes.invert_xaxis()
    axes.legend(fontsize=9, loc="lower right")


def figure11(evidence: Evidence) -> Figure:
    """Other assignments, other amounts and other robots."""
    figure, panels = plt.subplots(1, 3, figsize=(12, 4.4))
    tables = {
        learner: evidence.ensemble(learner, "assignments") for learner in ("improved", "ritter")
    }
    for kind, error in enumerate(ERRORS):
        for learner, table in tables.items():
            style, values = LEARNERS[learner], np.sort(table[f"final_{error}"])
            panels[0].step(
                values,
                np.arange(1, len(values) + 1) / len(values),
                color=style["color"],
                linestyle=("-", (0, (3, 2)))[kind],
                label=f"{learner.capitalize()}, {('cm', 'degrees')[kind]}",
            )
        scaled = evidence.ensemble("improved", "scaled").groupby("scale")
        style, marker = ((POSITION, "o"), (ORIENTATION, "s"))[kind]
        for moment, alpha in (("initial", 0.35), ("final", 1.0)):
            low, middle, high = (scaled[f"{moment}_{error}"].quantile(q) for q in (0.05, 0.5, 0.95))
            panels[1].fill_between(
                middle.index,
                low,
                high,
                color=style["color"],
                alpha=0.15 * alpha + 0.05,
                linewidth=0,
            )
            panels[1].plot(
                middle.index,
                middle,
                color=style["color"],
                marker=marker,
                linestyle=style["linestyle"],
                alpha=alpha,
                label=f"{moment} {('cm', 'degrees')[kind]}",
            )
    panels[0].set(
        xscale="log", xlabel="final error [cm, degrees]", ylabel="share of the assignments"
    )
    panels[0].set_xlim(left=panels[0].get_xlim()[0] / 2)  # room for the legend
    plain(panels[0].xaxis, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
    panels[0].set_title("Other links, encoders and signs", fontsize=11)
    panels[1].set(
        xscale="log",
        yscale="log",
        xlabel="size of the damage, times the paper's",
        ylabel="error [cm, degrees]",
    )
    plain(panels[1].xaxis, 0.1, 0.3, 1, 3)
    plain(panels[1].yaxis, 0.01, 0.1, 1, 10)
    panels[1].set_title("Other amounts (improved)", fontsize=11)
    robots = {evidence.robot: evidence.paper} | {
        robot: f"{evidence.paper}-{robot}" for robot in evidence.config["experiments"]["robots"]
    }
    places = np.arange(len(robots))
    for offset, (learner, style) in zip((-0.2, 0, 0.2), LEARNERS.items(), strict=True):
        left = [
            np.max(
                evidence.errors(learner, each).mean(axis=0)
                / evidence.errors(learner, each, "first").mean(axis=0)
            )
            for each in robots.values()
        ]
        panels[2].scatter(
            places + offset,
            100 * np.array(left),
            color=style["color"],
            marker=style["marker"],
            label=style["label"],
            zorder=3,
        )
    panels[2].set(yscale="log", ylabel="larger error left [% of the initial one]")
    plain(panels[2].yaxis, 2, 5, 10, 20, 50, 100)
    panels[2].set_xticks(places, [robot.upper() for robot in robots])
    panels[2].set_title("Other robots", fontsize=11)
    for axes, place in zip(panels, ("upper left", "lower right", "center left"), strict=True):
        axes.legend(fontsize=8, loc=place)
    title(
        figure,
        "Figure 11: other damages and other robots",
        "widths and rates as tuned for the paper's damage on the UR10; bands: 5-95 % of the assignments;"
        f" {len(tables['improved'])} for the improved map, {len(tables['ritter'])} for Ritter's",
    )
    return figure
