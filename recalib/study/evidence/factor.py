"""The factor of 70, asked in twelve ways: cells of Ritter's net, effort, definition."""

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.needs import DOUBLE
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.speedup import speed_up
from recalib.study.evidence.verdicts import Verdict, of_published
from recalib.study.measured import ERRORS
from recalib.study.multiverse.efforts import LONG
from recalib.study.statistics import Draws, Estimate

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
    table, own, rows = evidence.efforts(), evidence.fact("iterations"), []
    for (learner, cells), (effort, pair), definition in product(
        CELLS.items(), EFFORTS.items(), (ANEW, ON_THE_WAY)
    ):
        luck = evidence.rng("factor", learner, effort, definition)
        fast = errors_of(table, IMPROVED, pair[0])[own]
        slow = errors_of(table, learner, pair[1])
        if definition == ANEW and pair == ("full", "full"):
            estimate = leading(evidence, learner)  # as figures and claims have it
        elif definition == ANEW:
            final = {rung: errors[:, :, -1] for rung, errors in slow.items()}
            estimate = speed_up(final, {own: fast[:, :, -1]}, [own], luck)[0]
        else:
            grids = watched(table, learner, pair[1])
            estimate = on_the_way(slow, grids, fast[:, :, -1], own, luck)
        about = {"cells": cells, "effort": effort, "definition": definition}
        longest = max(slow) / own
        rows.append(about | {"factor": estimate, "longest": longest, "verdict": verdict(estimate)})
    return rows


def leading(evidence: Evidence, learner: str) -> Estimate:
    """The factor by the study's own ladders: equal and full effort, tuned anew."""
    ladders = evidence.ladder(learner), evidence.ladder(IMPROVED)
    luck = evidence.rng("speed-up", learner)
    return speed_up(*ladders, [evidence.fact("iterations")], luck)[0]


def verdict(estimate: Estimate) -> Verdict:
    """Of the published factor."""
    return of_published(PUBLISHED, estimate)


def errors_of(table: "pd.DataFrame", learner: str, effort: str) -> dict[int, np.ndarray]:
    """Errors (search, seed, measurement, 2) of a learner's trainings, by number of iterations."""
    named = table["training"].str.rpartition("_")[0] == learner
    own = table[named & (table["effort"] == effort)]
    found = {}
    for iterations, its in own.groupby("iterations"):
        its = its.sort_values(["search", "seed", "iteration"])
        shape = its["search"].nunique(), its["seed"].nunique(), its["iteration"].nunique(), 2
        found[int(iterations)] = its[list(ERRORS)].to_numpy().reshape(shape)
    return found


def watched(table: "pd.DataFrame", learner: str, effort: str) -> dict[int, np.ndarray]:
    """The iterations (measurement,) at which those errors were measured."""
    named = table["training"].str.rpartition("_")[0] == learner
    own = table[named & (table["effort"] == effort)]
    return {int(n): np.sort(its["iteration"].unique()) for n, its in own.groupby("iterations")}


def on_the_way(
    slow: dict[int, np.ndarray],
    grids: dict[int, np.ndarray],
    goal: np.ndarray,
    own: int,
    random: np.random.Generator,
) -> Estimate:
    """When a long training reaches both errors of another, over `own` iterations.

    Args:
        slow: errors (search, seed, measurement, 2) by number of iterations.
        grids: (measurement,) when they were measured.
        goal: (search, seed, 2) final errors of the other.

    It is the shortest of at least LONG iterations that reaches them on average; the longest, where
    none does. Infinite where it does not.
    """
    target = goal.mean(axis=(0, 1))
    long = [rung for rung in sorted(slow) if rung >= LONG]
    reaching = [rung for rung in long if (slow[rung][:, :, -1].mean(axis=(0, 1)) <= target).all()]
    rung = (reaching or long[-1:])[0]
    draws = Draws(random)
    within = (draws.means(slow[rung]) <= draws.means(goal)[:, None]).all(axis=-1)
    first = np.where(within.any(axis=1), grids[rung][within.argmax(axis=1)], np.inf)
    return draws.estimate(first / own)
