"""Figures of errors: how they fall, and how much of them remains."""

import re
from collections.abc import Sequence
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.judgement.factor import CELLS
from replication.judgement.intervals import first_within, typical
from replication.judgement.results import Evidence
from replication.pages.words import amounts
from replication.plots.palette import BOTH, ErrorStyle, Style, styles_of
from replication.plots.style import (
    BAND,
    band,
    finish,
    line_across,
    logarithmic,
    name_rows,
    note,
    with_intervals,
    words,
)
from replication.training.measured import ERRORS, errors_of

NAMED = 3  # damages in a title; more of them go by the name of their scenario
NEAR = 1.4  # times: two numbers beside an axis that would stand on each other
FLOOR = 1e-3  # cm and degrees: below it an error is rounding


def curves(history: pd.DataFrame, error: ErrorStyle) -> pd.DataFrame:
    """Errors by iteration (row) and seed (column)."""
    return history.pivot(index="iteration", columns="seed", values=error.column)


def label(style: Style, history: pd.DataFrame) -> str:
    """A learner's name, with its iterations."""
    return f"{style.label}, {history['iteration'].max():,} iterations"


def draw_band(axes: Axes, table: pd.DataFrame, color: str) -> None:
    """The spread of searches and seeds: 5th to 95th percentile at each iteration."""
    band(axes, table.index, np.percentile(table, BAND, axis=1), color)


def of_typical_search(history: pd.DataFrame) -> pd.DataFrame:
    """The rows of a history that belong to the typical search."""
    number = sorted(history["search"].unique())[typical(errors_of(history))]
    return history[history["search"] == number]


def draw_learning(axes: Axes, history: pd.DataFrame) -> None:
    """Both errors over the iterations on one scale, as in the paper's Figure 1."""
    bold = of_typical_search(history)
    for error in BOTH:
        draw_band(axes, curves(history, error), error.color)
        line = curves(bold, error).mean(axis=1)
        axes.plot(line.index, line, linewidth=2.4, label=error.kind, **error.line())
    axes.set(
        xlabel="iterations (two moves each)",
        ylabel="mean error [cm, degrees]",
        xlim=(0, history["iteration"].max()),
    )


def figure1(evidence: Evidence) -> Figure:
    """Figure 1 of the paper: the improved system on the paper's damage; right: on decades."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.6))
    history = evidence.history(evidence.facts["improved"])
    for axes in panels:
        draw_learning(axes, history)
    panels[0].set_ylim(0, None)
    logarithmic(panels[1].yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    ends = of_typical_search(history).groupby("iteration")[list(ERRORS)].mean()
    for error in BOTH:
        for axes, row, aside in zip(panels, (0, -1), (18, 4), strict=True):
            upper = ends.iloc[row][list(ERRORS)].idxmax() == error.column
            close = ends.iloc[row].max() < NEAR * ends.iloc[row].min()
            beside = (aside, (8 if upper else -8) if close else 0)
            note(
                axes,
                f"{ends[error.column].iloc[row]:.{2 if row else 1}f} {error.unit}",
                (ends.index[row], ends[error.column].iloc[row]),
                beside,
                va="center",
                color=error.color,
            )
    remaining = 100 * ends.iloc[-1] / ends.iloc[0]
    text = (
        f"Figure 1: after {ends.index[-1]} iterations, {remaining.iloc[0]:.0f} % of the position"
        f" error\nand {remaining.iloc[1]:.0f} % of the orientation error remain"
    )
    if not evidence.shipped:
        resolved = evidence.scenario()
        entries = [amounts(entry) for entry in resolved["damages"]]
        short = 0 < len(entries) <= NAMED
        damage = "; ".join(entries) if short else words(evidence.facts["scenario"])
        text += f"\n({evidence.study}: {resolved['robot'].upper()}, {damage})"
    seeds = history.groupby("search")["seed"].nunique().iloc[0]
    spread = f"means over {evidence.facts['tests']} test poses;"
    spread += f" bold: the median of {history['search'].nunique()} searches for widths and rates"
    spread += f", mean of its {seeds} seeds;"
    spread += f" band: {BAND[0]}-{BAND[1]} % of all {history['seed'].nunique()} runs"
    finish(figure, text, panels[0], 2, spread)
    return figure


def figure2(evidence: Evidence) -> Figure:
    """The learners on logarithmic axes, and the iterations that each needs for another's errors."""
    figure, panels = plt.subplots(1, 2, sharex=True, figsize=(10, 4.8))
    both = evidence.facts["compared"]
    compared = both if len(both) == 2 else []
    drawn = dict.fromkeys((*evidence.facts["learners"], *both))
    histories = {learner: evidence.history(learner) for learner in drawn}
    styles = styles_of(histories)
    shown = {learner: _by_cells(learner, style) for learner, style in styles.items()}
    for axes, error in zip(panels, BOTH, strict=True):
        for learner, history in histories.items():
            table = curves(history, error)
            table = table[table.index > 0]
            style = shown[learner]
            draw_band(axes, table, style.color)
            axes.plot(table.index, table.mean(axis=1), label=label(style, history), **style.line())
        first = next(iter(histories.values())).groupby("iteration")[error.column].mean().iloc[0]
        line_across(axes, f"before: {first:.2f}", y=first)
        reached = []
        for one, other in (compared, compared[::-1]) if compared else ():
            level = histories[other].groupby("iteration")[error.column].mean().iloc[-1]
            when = _reached(histories[one], [error.column], np.array([level]))
            name = shown[one].label.partition(",")[0]
            text = f"{name}: {level:.2f} after {when}"
            reached.append((level, text, shown[other].color))
        for (level, text, color), above in zip(sorted(reached), (False, True), strict=False):
            # two levels may be near to each other: dashes of one between those of the other
            dashes = (0 if above else 6, (6, 6))
            axes.axhline(level, color=color, linewidth=1, linestyle=dashes)
            note(
                axes,
                text,
                (0.01, level),
                (0, 3 if above else -3),
                xycoords=("axes fraction", "data"),
                va="bottom" if above else "top",
                fontsize=8,
                color=color,
            )
        axes.set(xlabel="iterations (two moves each)", ylabel=error.label)
        logarithmic(axes.xaxis, 1, 10, 100, 1000, 10_000)
        logarithmic(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    text = f"Figure 2: {_in_one_sentence(histories, compared)}"
    runs = ", ".join(f"{history['seed'].nunique()}" for history in histories.values())
    spread = (
        f"means of {runs} runs, over searches and seeds; bands: {BAND[0]}-{BAND[1]} %;"
        " each learner is tuned for its last iteration"
    )
    if compared:
        spread += (
            "\nlevel lines: a learner's final error, in its colour,"
            " and after how many iterations the other one reaches it"
        )
    finish(figure, text, panels[0], min(len(histories), 2), spread)
    return figure


def _by_cells(learner: str, style: Style) -> Style:
    """Ritter's with the cells that its net has."""
    cells = CELLS.get(re.sub(r"_\d+$", "", learner))
    return replace(style, label=f"Ritter's, cells of {cells}") if cells else style


def _in_one_sentence(histories: dict[str, pd.DataFrame], compared: Sequence[str]) -> str:
    if not compared:
        ends = {name: errors_of(its)[..., 0].mean() for name, its in histories.items()}
        best = min(ends, key=lambda name: ends[name])
        most, shown = histories[best]["iteration"].max(), styles_of(histories)[best].label
        return f"{shown} ends at the smallest error, {ends[best]:.2g} cm after {most:,} iterations"
    ritter, improved = (histories[learner] for learner in compared)
    cells = CELLS[re.sub(r"_\d+$", "", compared[0])]
    final = improved.groupby("iteration")[list(ERRORS)].mean().iloc[-1].to_numpy()
    reached = _reached(ritter, list(ERRORS), final)
    most = improved["iteration"].max()
    return (
        f"Ritter's map, with as many cells as {cells}, needs {reached}"
        f"\niterations for the errors that the improved system reaches in {most:,}"
    )


def _reached(history: pd.DataFrame, errors: list[str], level: np.ndarray) -> str:
    means = history.groupby("iteration")[errors].mean()
    first = first_within(means.index.to_numpy(), means.to_numpy(), level)
    return f"{first:,.0f}" if np.isfinite(first) else f"more than {means.index[-1]:,}"


def figure3(evidence: Evidence) -> Figure:
    """What remains of the initial errors in every scenario."""
    scenarios, learners = evidence.facts["scenarios"], evidence.facts["learners"]
    histories = {
        (scenario, learner): evidence.history(learner, scenario)
        for scenario in scenarios
        for learner in learners
    }
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(10, 4.8))
    rows = np.arange(len(scenarios))[::-1]
    offsets = 0.22 * (np.arange(len(learners))[::-1] - (len(learners) - 1) / 2)
    ends_of = []
    for axes, error in zip(panels, BOTH, strict=True):
        remaining = {}
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
        for offset, (learner, style) in zip(offsets, styles_of(learners).items(), strict=True):
            final = [curves(histories[scenario, learner], error).iloc[-1] for scenario in scenarios]
            means = np.maximum([values.mean() for values in final], FLOOR)
            remaining[learner] = means
            ends = np.maximum(np.percentile(final, BAND, axis=1), FLOOR)
            name = label(style, histories[scenarios[0], learner])
            with_intervals(axes, rows + offset, means, ends, name, style)
        axes.set_xlabel(f"{error.label}; {FLOOR:g} stands for less")
        logarithmic(axes.xaxis, 0.001, 0.01, 0.1, 1, 10)
        axes.set_xlim(FLOOR / 1.5, 30)
        name_rows(axes, rows, map(words, scenarios))
        ends_of.append(pd.DataFrame(remaining))
    lengths = {name: histories[scenarios[0], name]["iteration"].max() for name in learners}
    text = f"Figure 3: {_compared(ends_of, lengths)}"
    spread = f"signs: means over searches and seeds; lines: {BAND[0]}-{BAND[1]} % of the runs"
    finish(figure, text, panels[0], 1 + len(learners), spread)
    return figure


def _compared(ends: Sequence[pd.DataFrame], lengths: dict[str, int]) -> str:
    """Who has the smallest errors (scenario, learner) of those who learn least, and who less."""
    shown, shortest = styles_of(lengths), min(lengths.values())
    equal = [name for name, length in lengths.items() if length == shortest]
    wins = {name: [(its[name] <= its[equal].min(axis=1)).sum() for its in ends] for name in equal}
    best = max(equal, key=lambda name: sum(wins[name]))
    text = f"after {shortest:,} iterations, {shown[best].label} has the smallest"
    text += f" {_counts(wins[best])} of {len(ends[0])} scenarios"
    for name in (name for name in lengths if name not in equal):
        fewer = [(its[name] < its[best]).sum() for its in ends]
        text += f";\nafter {lengths[name]:,}, {shown[name].label} has smaller {_counts(fewer)}"
    return text


def _counts(numbers: Sequence[int]) -> str:
    if len(set(numbers)) == 1:
        return f"errors in {numbers[0]}"
    named = zip(numbers, BOTH, strict=True)
    return " and ".join(f"{error.kind} errors in {number}" for number, error in named)
