"""The factor of 70, asked in twelve ways: cells of Ritter's net, effort, definition."""

from functools import cache, partial
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

# When a training was measured (measurement,), and its errors (search, seed, measurement, 2)
Watched = tuple[np.ndarray, np.ndarray]

PUBLISHED = 70
CELLS = {DOUBLE: "both maps together", RITTER: "one map"}  # the paper's own reading first
AS_THE_PAPER = "as the paper: very rough, and optimized"
# What is sought with which effort: the improved system, and Ritter's.
EFFORTS = {
    "equal and full": ("full", "full"),
    "equal and rough": ("rough", "rough"),
    AS_THE_PAPER: ("rough", "full"),
}
ANEW, ON_THE_WAY = "tuned anew for each length", "on the way of one long training"


def factor_table(evidence: Evidence) -> list[dict]:
    """A row for each of the twelve: cells, effort, definition, the factor and its verdict."""
    own, rows = evidence.facts["iterations"], []
    its = cache(partial(watched, evidence.table(shipped.EFFORTS)))
    for (learner, cells), (effort, pair), definition in product(
        CELLS.items(), EFFORTS.items(), (ANEW, ON_THE_WAY)
    ):
        rng = evidence.rng("factor", learner, effort, definition)
        _, fast = its(IMPROVED, pair[0])[own]
        slow = its(learner, pair[1])
        longest = max(slow)
        if definition == ANEW and pair == ("full", "full"):
            estimate = leading(evidence, learner)  # as figures and claims have it
        elif definition == ANEW:
            final = {rung: errors[:, :, -1] for rung, (_, errors) in slow.items()}
            estimate = speed_up(final, {own: fast[:, :, -1]}, [own], rng)[0]
        else:
            longest, estimate = on_the_way(slow, fast[:, :, -1], own, rng)
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


def watched(table: "pd.DataFrame", learner: str, effort: str) -> dict[int, Watched]:
    """A learner's trainings, by number of iterations.

    The rough searches within a full one share its poses. So they count as more seeds of it, and
    not as searches of their own.
    """
    names = table["training"].unique()  # few, and in very many rows
    wanted = [name for name in names if name.rpartition("_")[0] == learner]
    found = {}
    for iterations, its in table[table["training"].isin(wanted)].groupby("iterations"):
        own = its[its["effort"] == effort].sort_values(["search", "seed", "iteration"])
        searches = its.loc[its["effort"] == "full", "search"].nunique()
        grid = np.sort(own["iteration"].unique())
        shape = searches, -1, len(grid), len(ERRORS)
        found[int(iterations)] = grid, own[list(ERRORS)].to_numpy().reshape(shape)
    return found


def on_the_way(
    slow: dict[int, Watched], goal: np.ndarray, own: int, random: np.random.Generator
) -> tuple[int, Estimate]:
    """How long a training is, and when it reaches both errors of another, over `own` iterations.

    The other's final errors (search, seed, 2) are the goal. The training is the shortest of at
    least LONG iterations that reaches them on average; the longest, where none does. Infinite where
    it does not reach them.
    """
    target = goal.mean(axis=(0, 1))
    long = [rung for rung in sorted(slow) if rung >= LONG]
    last = {rung: slow[rung][1][:, :, -1].mean(axis=(0, 1)) for rung in long}
    rung = next((rung for rung in long if np.all(last[rung] <= target)), long[-1])
    grid, errors = slow[rung]
    draws = Draws(random, errors, goal)
    within = np.all(draws.means(errors) <= draws.means(goal)[:, None], axis=-1)
    first = np.where(within.any(axis=1), grid[within.argmax(axis=1)], np.inf)
    return rung, draws.estimate(first / own)
