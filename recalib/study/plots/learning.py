"""Figures of errors: how they fall, and what is left of them."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.evidence.results import Evidence
from recalib.study.plots.style import BAND, LABELS, LEARNERS, ORIENTATION, POSITION, plain, title
from recalib.study.statistics import first_within


def curves(history: pd.DataFrame, error: str) -> pd.DataFrame:
    """Errors by iteration (row) and seed (column)."""
    return history.pivot(index="iteration", columns="seed", values=error)


def draw_band(axes: Axes, table: pd.DataFrame, color: str) -> None:
    """The spread of the seeds: 5th to 95th percentile at each iteration."""
    low, high = np.percentile(table, BAND, axis=1)
    axes.fill_between(table.index, low, high, color=color, alpha=0.2, linewidth=0)


def draw_learning(axes: Axes, history: pd.DataFrame, seed: int = 0) -> Axes:
    """Both errors over the iterations on one scale, as in the paper's Figure 1: one run bold before the spread of all."""
    for error, style, name in (
        ("position_error_cm", POSITION, "position"),
        ("orientation_error_deg", ORIENTATION, "orientation"),
    ):
        table = curves(history, error)
        draw_band(axes, table, style["color"])
        axes.plot(table.index, table[seed], linewidth=2.4, label=name, **style)
        unit = "cm" if error.endswith("cm") else "degrees"
        axes.annotate(
            f"{name}: {table[seed].iloc[0]:.1f} {unit}",
            (table.index[0], table[seed].iloc[0]),
            (26, 3),
            textcoords="offset points",
            color=style["color"],
        )
    last = [curves(history, error).iloc[-1].mean() for error in LABELS]
    axes.annotate(
        f"after {history['iteration'].max()} iterations, mean of {history['seed'].nunique()} seeds:\n"
        f"{last[0]:.2f} cm and {last[1]:.2f} degrees",
        (table.index[-1], max(last)),
        (0, 28),
        textcoords="offset points",
        ha="right",
    )
    axes.set(
        xlabel="iterations (two moves each)",
        ylabel="mean error on 200 test poses [cm, degrees]",
        xlim=(0, history["iteration"].max()),
    )
    axes.set_ylim(bottom=0)
    axes.legend(
        title=f"bold: one run; band: {BAND[0]}-{BAND[1]} % of {history['seed'].nunique()} seeds"
    )
    return axes


def figure1(evidence: Evidence) -> Figure:
    """Figure 1 of the paper: the improved system on the paper's damage."""
    figure, axes = plt.subplots()
    draw_learning(axes, evidence.history("improved"))
    axes.set_title("Figure 1: within 200 iterations, the damaged arm finds its poses again")
    return figure


def figure2(evidence: Evidence) -> Figure:
    """Improved against Ritter on logarithmic axes, with the iterations that each needs for the other's final errors."""
    figure, panels = plt.subplots(1, 2, sharex=True, figsize=(10, 4.8))
    histories = {learner: evidence.history(learner) for learner in LEARNERS}
    for axes, (error, label) in zip(panels, LABELS.items(), strict=True):
        for learner, history in histories.items():
            table = curves(history, error)
            table = table[table.index > 0]
            style = LEARNERS[learner]
            draw_band(axes, table, style["color"])
            axes.plot(table.index, table.mean(axis=1), **{**style, "marker": None})
        for one, other in (("ritter", "improved"), ("improved", "ritter")):
            level = histories[other].groupby("iteration")[error].mean().iloc[-1]
            reached = _reached(histories[one], [error], np.array([level]))
            axes.axhline(level, color="0.4", linewidth=0.8)
            note = f"{one.capitalize()} is at {level:.2f} {reached}"
            axes.annotate(
                note,
                (0.02, level),
                (0, 3),
                xycoords=("axes fraction", "data"),
                textcoords="offset points",
                fontsize=9,
            )
        axes.set(xscale="log", yscale="log", xlabel="iterations (two moves each)", ylabel=label)
        plain(axes.xaxis, 1, 10, 100, 1000, 10_000)
        plain(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    final = histories["improved"].groupby("iteration")[list(LABELS)].mean().iloc[-1].to_numpy()
    both = _reached(histories["ritter"], list(LABELS), final)
    title(
        figure,
        f"Figure 2: what the improved map reaches in 200 iterations, Ritter's reaches {both}",
    )
    seeds = ", ".join(f"{history['seed'].nunique()}" for history in histories.values())
    figure.legend(
        *panels[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=3,
        fontsize=9,
        title=f"lines: means of {seeds} seeds; bands: {BAND[0]}-{BAND[1]} % of them",
        title_fontsize=9,
    )
    return figure


def _reached(history: pd.DataFrame, errors: list[str], level: np.ndarray) -> str:
    means = history.groupby("iteration")[errors].mean()
    first = first_within(means.index.to_numpy(), means.to_numpy(), level)
    return f"after {first:,.0f}" if np.isfinite(first) else f"in none of its {means.index[-1]:,}"


FLOOR = 1e-3  # cm and degrees: below it an error is rounding


def figure3(evidence: Evidence) -> Figure:
    """What is left of the initial errors in every scenario."""
    scenarios = evidence.scenarios
    histories = {
        (scenario, learner): evidence.history(learner, scenario)
        for scenario in scenarios
        for learner in LEARNERS
    }
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(10, 4.8))
    rows = np.arange(len(scenarios))[::-1]
    for axes, (error, label) in zip(panels, LABELS.items(), strict=True):
        initial = [
            curves(histories[scenario, "improved"], error).iloc[0].mean() for scenario in scenarios
        ]
        axes.scatter(
            np.maximum(initial, FLOOR),
            rows,
            s=60,
            facecolors="none",
            edgecolors="0.3",
            label="before recalibration",
            zorder=3,
        )
        for offset, (learner, style) in zip((0.22, 0, -0.22), LEARNERS.items(), strict=True):
            final = [curves(histories[scenario, learner], error).iloc[-1] for scenario in scenarios]
            means = np.maximum([values.mean() for values in final], FLOOR)
            low, high = np.maximum(np.percentile(final, BAND, axis=1), FLOOR)
            axes.hlines(rows + offset, low, high, color=style["color"], linewidth=1.5)
            axes.scatter(
                means,
                rows + offset,
                s=36,
                color=style["color"],
                marker=style["marker"],
                label=style["label"],
                zorder=3,
            )
        axes.set(xscale="log", xlabel=f"{label}; {FLOOR:g} stands for less", xlim=(FLOOR / 1.5, 30))
        plain(axes.xaxis, 0.001, 0.01, 0.1, 1, 10)
        axes.set_yticks(rows, [scenario.replace("_", " and ") for scenario in scenarios])
        axes.grid(axis="y", visible=False)
    title(
        figure,
        "Figure 3: every kind of damage is learned, and an intact robot is left alone by the improved map",
    )
    figure.legend(
        *panels[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=4,
        fontsize=9,
        title=f"signs: means over seeds; lines: {BAND[0]}-{BAND[1]} % of the seeds",
        title_fontsize=9,
    )
    return figure
