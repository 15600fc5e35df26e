"""Figures of learning: the course of both errors, and remaining errors by scenario and damage."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.judgement.evidence import Evidence
from replication.plots.palette import BOTH, GREY, ErrorStyle, styles_of_trainings
from replication.plots.style import (
    BAND,
    MARK,
    WIDTH,
    band,
    legend_below,
    logarithmic,
    name_rows,
    note,
    words,
)
from replication.training.measured import ERRORS
from replication.training.plan import leading, places

NEAR = 1.4  # ratio of two numbers, below which their labels would overlap
FLOOR = 1e-3  # cm and degrees: smaller errors are rounding
MOVES = "iterations (two moves each)"


def curves(history: pd.DataFrame, error: ErrorStyle) -> pd.DataFrame:
    """Errors by iteration (row) and seed (column)."""
    return history.pivot(index="iteration", columns="seed", values=error.column)


def figure_1(evidence: Evidence) -> Figure:
    """Figure 1 of the paper: both errors with the paper's damage; right: on a logarithmic scale."""
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 2.5))
    history = evidence.history(*leading(evidence.study))
    means = history.groupby("iteration")[list(ERRORS)].mean()
    for axes, row, aside in zip(panels, (0, -1), (6, 3), strict=True):
        for error in BOTH:
            table = curves(history, error)
            band(axes, table.index, np.percentile(table, BAND, axis=1), error.color)
            axes.plot(means.index, means[error.column], label=error.kind, **error.line())
        axes.set(xlabel=MOVES, xlim=(0, means.index[-1]))
        _label_ends(axes, means, row, aside)
    panels[0].set(ylim=(0, None), ylabel="mean error [cm, degrees]")
    logarithmic(panels[1].yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    legend_below(figure, panels[0], 2)
    return figure


def _label_ends(axes: Axes, means: pd.DataFrame, row: int, aside: float) -> None:
    """Write both errors next to the curves' beginnings or ends, without overlap."""
    errors = means.iloc[row]
    close = errors.max() < NEAR * errors.min()
    for error in BOTH:
        shift = (5 if errors[error.column] == errors.max() else -5) if close else 0
        note(
            axes,
            f"{errors[error.column]:.{2 if row else 1}f} {error.unit}",
            (means.index[row], errors[error.column]),
            (aside, shift),
            va="center",
            color=error.color,
        )


def learners(evidence: Evidence) -> Figure:
    """All learners in the scenario of Figure 1, on logarithmic axes."""
    training = leading(evidence.study)
    styles = styles_of_trainings(evidence.study.experiments.learners)
    figure, panels = plt.subplots(1, 2, sharex=True, figsize=(WIDTH, 3.1))
    for axes, error in zip(panels, BOTH, strict=True):
        for (learner, iterations), style in styles.items():
            table = curves(evidence.history(learner, iterations, training.scenario), error)
            table = table[table.index > 0]
            band(axes, table.index, np.percentile(table, BAND, axis=1), style.color)
            axes.plot(table.index, table.mean(axis=1), label=style.label, **style.line())
        final = curves(evidence.history(*training), error).iloc[-1].mean()
        color = styles[training.learner, training.iterations].color
        axes.axhline(final, color=color, linewidth=0.8)
        note(
            axes,
            f"{final:.2f} {error.unit}",
            (0.02, final),
            (0, -2),
            xycoords=("axes fraction", "data"),
            va="top",
            color=color,
        )
        axes.set(xlabel=MOVES, ylabel=error.label)
        logarithmic(axes.xaxis, 1, 100, 10_000)
        logarithmic(axes.yaxis, 0.1, 0.2, 0.5, 1, 2, 5, 10)
    legend_below(figure, panels[0], 1)
    return figure


def scenarios(evidence: Evidence) -> Figure:
    """Both errors before and after learning in every scenario, and on every robot."""
    main = evidence.study.experiments.learners
    planned = places(evidence.study)
    trained = [place for place in planned if main.keys() <= planned[place].keys()]
    names = [
        words(place.scenario)
        + (f",\non the {place.robot.upper()}" if place.robot != evidence.study.robot else "")
        for place in trained
    ]
    rows = np.arange(len(trained))[::-1]
    styles = styles_of_trainings(main)
    figure, panels = plt.subplots(1, 2, sharey=True, figsize=(WIDTH, 1.4 + 0.34 * len(rows)))
    offsets = 0.24 * (np.arange(len(styles))[::-1] - (len(styles) - 1) / 2)
    for axes, error in zip(panels, BOTH, strict=True):
        histories = {
            training: [
                curves(evidence.history(*training, place.scenario, place.robot), error)
                for place in trained
            ]
            for training in styles
        }
        before = [history.iloc[0].mean() for history in next(iter(histories.values()))]
        axes.scatter(
            np.maximum(before, FLOOR),
            rows,
            s=1.5 * MARK,
            facecolors="none",
            edgecolors=GREY,
            label="before learning",
            zorder=3,
        )
        for offset, (training, style) in zip(offsets, styles.items(), strict=True):
            final = [history.iloc[-1].to_numpy() for history in histories[training]]
            means = np.maximum([errors.mean() for errors in final], FLOOR)
            ends = np.maximum(np.percentile(final, BAND, axis=1), FLOOR)
            axes.hlines(rows + offset, *ends, color=style.color, linewidth=1.2)
            signs = {"label": style.label, **style.signs()}
            axes.scatter(means, rows + offset, s=MARK, zorder=3, **signs)
        axes.set_xlabel(f"{error.kind} [{error.unit}]")
        logarithmic(axes.xaxis, 0.001, 0.1, 10)
        axes.set_xlim(FLOOR / 1.5, 30)
        name_rows(axes, rows, names)
    legend_below(figure, panels[0], 2)
    return figure


def amounts(evidence: Evidence) -> Figure:
    """Both errors of the improved system before and after learning, by the size of the damage."""
    by_size = evidence.table("ensemble.parquet").groupby("scale")
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 2.6))
    for axes, error in zip(panels, BOTH, strict=True):
        for moment, color, marker, text, at, side in (
            ("initial", GREY, "^", "before", (0.04, 0.95), "left"),
            ("final", error.color, error.marker, "after", (0.98, 0.05), "right"),
        ):
            errors = by_size[f"{moment}_{error.column}"]
            low, middle, high = (
                errors.quantile(share) for share in (BAND[0] / 100, 0.5, BAND[1] / 100)
            )
            band(axes, middle.index, (low, high), color)
            axes.plot(middle.index, middle, color=color, marker=marker)
            note(axes, text, at, (0, 0), xycoords="axes fraction", ha=side, color=color)
        axes.set(xlabel="size of the damage (paper: 1)", ylabel=error.label)
        logarithmic(axes.xaxis, 0.1, 0.3, 1, 3)
        logarithmic(axes.yaxis, 0.01, 0.1, 1, 10)
    return figure
