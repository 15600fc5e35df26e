"""The reference study's trainings for the factor of 70, by the effort of the search.

A full search is one of workflow/search. Its first round holds several rough ones, of as many
quasi-random trials each as a rough search has.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.study import jobs
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.experiments.samples import read_sample
from recalib.study.experiments.settings import best, build
from recalib.study.lengths import LONG
from recalib.study.plants import Resolved

if TYPE_CHECKING:
    import pandas as pd

FIRST, WATCHED = 1000, 60  # iterations and measurements: nobody gets there earlier


def efforts(job: jobs.Efforts, scenario: str | Path, sample: str | Path) -> "pd.DataFrame":
    """Errors of the winners of all searches for a training, full and rough, each with its seeds.

    Args:
        scenario: file of the scenario as resolved.
        sample: file of the searches for this training.

    Returns a row for each effort, search, seed and measurement: the last one, and in a long
    training those on its way.
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    trials = read_sample(sample)
    return pd.concat(
        [
            _trained(job, scenario, winners).assign(effort=effort)
            for effort, winners in (("full", best(trials)), ("rough", rough(trials, job.rough)))
        ],
        ignore_index=True,
    )


def rough(trials: "pd.DataFrame", size: int) -> "pd.DataFrame":
    """Winners of the rough searches that the first rounds hold: so many trials after another."""
    first = trials[trials["round"] == 1]
    groups = [first["search"], first.groupby("search").cumcount() // size]
    return first.loc[first.groupby(groups)["score"].idxmin()]


def _trained(job: jobs.Efforts, scenario: str | Path, winners: "pd.DataFrame") -> "pd.DataFrame":
    """Winners (a row each) trained with `job.seeds` seeds each; all see the same poses by seed."""
    import pandas as pd

    resolved, iterations = Resolved.read(scenario), job.learner.iterations
    seeds = list(range(job.seeds)) * len(winners)
    grid = [iterations]
    if iterations >= LONG:
        grid = np.geomspace(FIRST, iterations, WATCHED).round().astype(int).tolist()
    settings = np.repeat(winners.to_dict("records"), job.seeds)
    history = train_for_results(
        resolved.plant(resolved.controller(), job.seed, seeds),
        build(job.learner, settings),
        Stream.EFFORTS.draw(job.seed, seeds, iterations, job.tests),
        grid,
    )
    runs = np.arange(len(seeds))
    return pd.DataFrame(
        {
            "search": np.repeat(runs // job.seeds, len(grid)),
            "seed": np.repeat(seeds, len(grid)),
            "iterations": iterations,
            "iteration": np.tile(grid, len(runs)),
            "position_error_cm": 100 * history.position[..., 0].ravel(),
            "orientation_error_deg": np.degrees(history.orientation[..., 0]).ravel(),
        }
    )
