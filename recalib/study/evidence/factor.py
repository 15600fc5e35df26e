"""The factor of 70, asked in twelve ways: cells of Ritter's net, effort, definition."""

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from recalib.study.configuration import shipped
from recalib.study.configuration.lengths import LONG
from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.needs import DOUBLE
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.speedup import speed_up
from recalib.study.evidence.verdicts import Verdict, of_published
from recalib.study.inference.intervals import Draws, Estimate
from recalib.study.inference.measured import ERRORS

if TYPE_CHECKING:
    import pandas as pd

PUBLISHED = 70
CELLS = {DOUBLE: "both maps together", RITTER: "one map"}  # the paper's own reading first
# What is sought with which effort: the improved system, and Ritter's.
EFFORTS = {
    "equal and full": ("full", "full"),
    "equal and rough": ("rough", "rough"),
    "as the paper: very rough, and optimized": ("rough", "full"),
}
ANEW, ON_THE_WAY = "tuned anew for each length", "on the way of one long training"


def factor_table(evidence: Evidence) -> list[dict]:
    """A row for each of the twelve: cells, effort, definition, the factor and its verdict."""
    table, own, rows = evidence.table(shipped.EFFORTS), evidence.facts["iterations"], []
    for (learner, cells), (effort, pair), definition in product(
        CELLS.items(), EFFORTS.items(), (ANEW, ON_THE_WAY)
    ):
        rng = evidence.rng("factor", learner, effort, definition)
        fast = errors_of(table, IMPROVED, pair[0])[own]
        slow = errors_of(table, learner, pair[1])
        longest = max(slow)
        if definition == ANEW and pair == ("full", "full"):
            estimate = leading(evidence, learner)  # as figures and claims have it
        elif definition == ANEW:
            final = {rung: errors[:, :, -1] for rung, errors in slow.items()}
            estimate = speed_up(final, {own: fast[:, :, -1]}, [own], rng)[0]
        else:
            grids = watched(table, learner)
            longest, estimate = on_the_way(slow, grids, fast[:, :, -1], own, rng)
        about = {"cells": cells, "effort": effort, "definition": definition}
        judged = {"factor": estimate, "longest": longest / own, "verdict": in_words(estimate)}
        rows.append(about | judged)
    return rows


def leading(evidence: Evidence, learner: str) -> Estimate:
    """The factor by the study's own ladders: equal and full effort, tuned anew."""
    ladders = evidence.ladder(learner), evidence.ladder(IMPROVED)
    rng = evidence.rng("speed-up", learner)
    return speed_up(*ladders, [evidence.facts["iterations"]], rng)[0]


def verdict(estimate: Estimate) -> Verdict:
    """Of the published factor."""
    return of_published(PUBLISHED, estimate)


def in_words(estimate: Estimate) -> str:
    """That verdict, and on which side of the published factor an interval without it lies."""
    judged = verdict(estimate)
    if judged is not Verdict.CONTRADICTED:
        return str(judged)
    return f"{judged}: the factor is {'larger' if estimate.low > PUBLISHED else 'smaller'}"


def errors_of(table: "pd.DataFrame", learner: str, effort: str) -> dict[int, np.ndarray]:
    """Errors (search, seed, measurement, 2) of a learner's trainings, by number of iterations.

    The rough searches within a full one share its poses. So they count as more seeds of it, and
    not as searches of their own.
    """
    found = {}
    for iterations, its in _trainings(table, learner).groupby("iterations"):
        own = its[its["effort"] == effort].sort_values(["search", "seed", "iteration"])
        searches = its.loc[its["effort"] == "full", "search"].nunique()
        shape = searches, -1, own["iteration"].nunique(), len(ERRORS)
        found[int(iterations)] = own[list(ERRORS)].to_numpy().reshape(shape)
    return found


def watched(table: "pd.DataFrame", learner: str) -> dict[int, np.ndarray]:
    """The iterations (measurement,) at which those errors were measured."""
    groups = _trainings(table, learner).groupby("iterations")["iteration"]
    return {int(iterations): np.sort(its.unique()) for iterations, its in groups}


def _trainings(table: "pd.DataFrame", learner: str) -> "pd.DataFrame":
    names = table["training"].unique()  # few, and in very many rows
    return table[table["training"].isin([n for n in names if n.rpartition("_")[0] == learner])]


def on_the_way(
    slow: dict[int, np.ndarray],
    grids: dict[int, np.ndarray],
    goal: np.ndarray,
    own: int,
    random: np.random.Generator,
) -> tuple[int, Estimate]:
    """How long a training is, and when it reaches both errors of another, over `own` iterations.

    Args:
        slow: errors (search, seed, measurement, 2) by number of iterations.
        grids: (measurement,) when they were measured.
        goal: (search, seed, 2) final errors of the other.

    It is the shortest of at least LONG iterations that reaches them on average; the longest, where
    none does. Infinite where it does not reach them.
    """
    target = goal.mean(axis=(0, 1))
    long = [rung for rung in sorted(slow) if rung >= LONG]
    reaching = [rung for rung in long if np.all(slow[rung][:, :, -1].mean(axis=(0, 1)) <= target)]
    rung = (reaching or long[-1:])[0]
    draws = Draws(random)
    within = np.all(draws.means(slow[rung]) <= draws.means(goal)[:, None], axis=-1)
    first = np.where(within.any(axis=1), grids[rung][within.argmax(axis=1)], np.inf)
    return rung, draws.estimate(first / own)
