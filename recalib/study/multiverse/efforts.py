"""The reference study's trainings for the factor of 70, by the effort of the search.

A full search is one of workflow/search. Its first round holds several rough ones, of as many
quasi-random trials each as a rough search has.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from recalib.study.configuration.lengths import LONG
from recalib.study.configuration.study import LearnerSettings
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.experiments.samples import read_sample
from recalib.study.experiments.settings import best, build
from recalib.study.inference.measured import ERRORS
from recalib.study.scenarios.plants import Resolved

FIRST, WATCHED = 1000, 60  # iterations and measurements: nobody gets there earlier


def efforts(
    scenario: Path,
    sample: Path,
    training: str,
    learner: LearnerSettings,
    rough_trials: int,
    seeds: int,
    tests: int,
    seed: int,
) -> pd.DataFrame:
    """Errors of the winners of all searches for a training, full and rough, each with its seeds.

    Args:
        scenario: file of the scenario as resolved.
        sample: file of the searches for this training.
        rough_trials: of a rough search.
        seeds: of each winner.
        tests: poses to measure on.

    Returns a row for each effort, search, seed and measurement: the last one, and in a long
    training those on its way.
    """
    trials, found = read_sample(sample), []
    for effort, winners in (("full", best(trials)), ("rough", rough(trials, rough_trials))):
        table = _trained(Resolved.read(scenario), learner, winners, seeds, tests, seed)
        found.append(table.assign(effort=effort))
    table = pd.concat(found, ignore_index=True)
    table.insert(0, "training", training)
    return table


def rough(trials: pd.DataFrame, size: int) -> pd.DataFrame:
    """Winners of the rough searches that the first rounds hold: so many trials after another."""
    first = trials[trials["round"] == 1]
    groups = [first["search"], first.groupby("search").cumcount() // size]
    return first.loc[first.groupby(groups)["score"].idxmin()]


def _trained(
    resolved: Resolved,
    learner: LearnerSettings,
    winners: pd.DataFrame,
    each: int,
    tests: int,
    seed: int,
) -> pd.DataFrame:
    """Winners (a row each) trained with `each` seeds each; all see the same poses by seed."""
    iterations, seeds = learner.iterations, list(range(each)) * len(winners)
    grid = [iterations]
    if iterations >= LONG:
        grid = np.geomspace(FIRST, iterations, WATCHED).round().astype(int).tolist()
    settings = [winner for winner in winners.to_dict("records") for _ in range(each)]
    history = train_for_results(
        resolved.plant(resolved.controller(), seed, seeds),
        build(learner, settings),
        Stream.EFFORTS.draw(seed, seeds, iterations, tests),
        grid,
    )
    table = pd.DataFrame(history.columns())
    by_run = {"search": table["run"] // each, "seed": table["run"] % each, "iterations": iterations}
    return pd.DataFrame(by_run | {name: table[name] for name in ("iteration", *ERRORS)})
