"""Figures of errors: how they fall, and what is left of them."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from recalib.study.evidence.results import Evidence
from recalib.study.measured import ERRORS, KINDS, UNITS, errors_of
from recalib.study.plots.looks import looks
from recalib.study.plots.steady import LOG
from recalib.study.plots.style import (
    BAND,
    BORDER,
    LABELS,
    ORIENTATION,
    POSITION,
    legend_below,
    plain,
    title,
    words,
)
from recalib.study.statistics import first_within, typical

FLOOR = 1e-3  # cm and degrees: below it an error is rounding


def curves(history: pd.DataFrame, error: str) -> pd.DataFrame:
    """Errors by iteration (row) and seed (column)."""
    return history.pivot(index="iteration", columns="seed", values=error)


def label(look, history: pd.DataFrame) -> str:
    """A learner's name, with its iterations."""
    return f"{look.label}, {history['iteration'].max():,} iterations"


def draw_band(axes: Axes, table: pd.DataFrame, color: str) -> None:
    """The spread of searches and seeds: 5th to 95th percentile at each iteration."""
    low, high = np.percentile(table, BAND, axis=1)
    axes.fill_between(table.index, low, high, color=color, alpha=0.2, linewidth=0)


def of_typical_search(history: pd.DataFrame) -> pd.DataFrame:
    """The rows of a history that belong to the typical search."""
    number = sorted(history["search"].unique())[typical(errors_of(history))]
    return history[history["search"] == number]


def draw_learning(axes: Axes, history: pd.DataFrame, tests: int) -> Axes:
    """Both errors over the iterations on one scale, as in the paper's Figure 1.

    Args:
        axes: where to draw.
        history: of a training.
        tests: poses of each measurement.
    """
    bold, searches = of_typical_search(history), history["search"].nunique()
    last = {}
    for error, style, name, unit in zip(ERRORS, (POSITION, ORIENTATION), KINDS, UNITS, strict=True):
        table = curves(history, error)
        draw_band(axes, table, style["color"])
        line = curves(bold, error).mean(axis=1)
        last[error] = line.iloc[-1]
        axes.plot(line.index, line, linewidth=2.4, label=name, **style)
        axes.annotate(
            f"{name}: {line.iloc[0]:.1f} {unit}",
            (line.index[0], line.iloc[0]),
            (26, 3),
            textcoords="offset points",
            color=style["color"],
        )
    axes.annotate(
        f"after {history['iteration'].max()} iterations of the typical search:\n"
        f"{last[ERRORS[0]]:.2f} cm and {last[ERRORS[1]]:.2f} degrees",
        (history["iteration"].max(), max(last.values())),
        (0, 28),
        textcoords="offset points",
        ha="right",
    )
    axes.set(
        xlabel="iterations (two moves each)",
        ylabel=f"mean error on {tests} test poses [cm, degrees]",
        xlim=(0, history["iteration"].max()),
    )
    axes.set_ylim(bottom=0)
    axes.legend(
        title=f"bold: the median of {searches} searches for widths and rates,\n"
        f"mean of its {bold['seed'].nunique()} seeds; band: {BAND[0]}-{BAND[1]} % of all"
        f" {history['seed'].nunique()} runs",
        title_fontsize=9,
    )
    return axes


def figure1(evidence: Evidence) -> Figure:
    """Figure 1 of the paper: the improved system on the paper's damage."""
    figure, axes = plt.subplots()
    history = evidence.history(evidence.fact("improved"))
    draw_learning(axes, history, evidence.fact("tests"))
    ends = of_typical_search(history).groupby("iteration")[list(ERRORS)].mean()
    left = 100 * ends.iloc[-1] / ends.iloc[0]
    text = (
        f"Figure 1: both errors over {ends.index[-1]} iterations;"
        f" {left.iloc[0]:.0f} % and {left.iloc[1]:.0f} % of them are left"
    )
    if not evidence.shipped:
        where = f"{evidence.fact('robot').upper()}, {words(evidence.fact('scenario'))}"
        text += f"\n({evidence.study}: {where})"
    axes.set_title(text)
    return figure


def figure2(evidence: Evidence) -> Figure:
    """The learners on logarithmic axes, and the iterations that each needs for another's errors."""
    figure, panels = plt.subplots(1, 2, sharex=True, figsize=(10, 4.8))
    histories = {learner: evidence.history(learner) for learner in evidence.fact("learners")}
    shown = looks(histories)
    # Ritter's and the improved one, where both are there
    there = [learner for learner in evidence.fact("compared") if learner in histories]
    compared = there if len(there) == 2 else []
    for axes, (error, text) in zip(panels, LABELS.items(), strict=True):
        for learner, history in histories.items():
            table = curves(history, error)
            table = table[table.index > 0]
            look = shown[learner]
            draw_band(axes, table, look.color)
            axes.plot(table.index, table.mean(axis=1), label=label(look, history), **look.line())
        for one, other in (compared, compared[::-1]) if compared else ():
            level = histories[other].groupby("iteration")[error].mean().iloc[-1]
            reached = _reached(histories[one], [error], np.array([level]))
            axes.axhline(level, **BORDER)
            axes.annotate(
                f"{shown[one].label.capitalize()} is at {level:.2f} {reached}",
                (0.02, level),
                (0, 3),
                xycoords=("axes fraction", "data"),
                textcoords="offset points",
                fontsize=9,
            )
        axes.set(xscale=LOG, yscale=LOG, xlabel="iterations (two moves each)", ylabel=text)
        plain(axes.xaxis, 1, 10, 100, 1000, 10_000)
        plain(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    title(figure, f"Figure 2: {_in_one_sentence(histories, compared)}")
    runs = ", ".join(f"{history['seed'].nunique()}" for history in histories.values())
    spread = f"lines: means of {runs} runs, over searches and seeds; bands: {BAND[0]}-{BAND[1]} %"
    legend_below(figure, panels[0], len(histories), spread)
    return figure


def _in_one_sentence(histories: dict[str, pd.DataFrame], compared: Sequence[str]) -> str:
    if not compared:
        return "errors over the iterations"
    ritter, improved = (histories[learner] for learner in compared)
    final = improved.groupby("iteration")[list(ERRORS)].mean().iloc[-1].to_numpy()
    reached = _reached(ritter, list(ERRORS), final)
    most = improved["iteration"].max()
    return f"what the improved map reaches in {most:,} iterations, Ritter's reaches {reached}"


def _reached(history: pd.DataFrame, errors: list[str], level: np.ndarray) -> str:
    means = history.groupby("iteration")[errors].mean()
    first = first_within(means.index.to_numpy(), means.to_numpy(), level)
    return f"after {first:,.0f}" if np.isfinite(first) else f"in none of its {means.index[-1]:,}"


def figure3(evidence: Evidence) -> Figure:
    """What is left of the initial errors in every scenario."""
    scenarios, learners = evidence.fact("scenarios"), evidence.fact("learners")
    histories = {
        (scenario, learner): evidence.history(learner, scenario)
        for scenario in scenarios
        for learner in learners
    }
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(10, 4.8))
    rows = np.arange(len(scenarios))[::-1]
    offsets = 0.22 * (np.arange(len(learners))[::-1] - (len(learners) - 1) / 2)
    for axes, (error, text) in zip(panels, LABELS.items(), strict=True):
        initial = [
            curves(histories[scenario, learners[0]], error).iloc[0].mean() for scenario in scenarios
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
        for offset, (learner, look) in zip(offsets, looks(learners).items(), strict=True):
            final = [curves(histories[scenario, learner], error).iloc[-1] for scenario in scenarios]
            means = np.maximum([values.mean() for values in final], FLOOR)
            low, high = np.maximum(
                np.transpose([np.percentile(values, BAND) for values in final]), FLOOR
            )
            axes.hlines(rows + offset, low, high, color=look.color, linewidth=1.5)
            name = label(look, histories[scenarios[0], learner])
            axes.scatter(means, rows + offset, s=36, label=name, zorder=3, **look.signs())
        axes.set(xscale=LOG, xlabel=f"{text}; {FLOOR:g} stands for less", xlim=(FLOOR / 1.5, 30))
        plain(axes.xaxis, 0.001, 0.01, 0.1, 1, 10)
        axes.set_yticks(rows, [words(scenario) for scenario in scenarios])
        axes.grid(axis="y", visible=False)
    title(figure, "Figure 3: errors before and after learning, in every scenario")
    spread = f"signs: means over searches and seeds; lines: {BAND[0]}-{BAND[1]} % of the runs"
    legend_below(figure, panels[0], 1 + len(learners), spread)
    return figure
