"""Trials of the search, evaluated on seeds and poses that nothing else uses."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.study import jobs
from recalib.study.experiments import search
from recalib.study.experiments.campaign import desired_poses, test_poses
from recalib.study.experiments.settings import best, rules_of
from recalib.study.plants import Resolved
from recalib.training import train

DIGITS = 4  # of an error, so that the files that keep it are the same on every machine


def evaluate(job: jobs.Trials, scenario: str | Path, earlier: Sequence[str | Path]) -> pd.DataFrame:
    """The errors of some trials of a round, a row each.

    Args:
        scenario: file of the scenario as resolved.
        earlier: files of all trials of the rounds before.
    """
    rules, resolved = rules_of(job.learner), Resolved.read(scenario)
    centre = best(pd.concat(map(pd.read_csv, earlier), ignore_index=True)) if earlier else None
    ranges = dict(job.ranges)
    drawn = search.draw(rules, ranges, job.trials, job.seed + job.round, centre)
    trials = drawn[job.first : job.last]
    seeds, scope = range(job.seeds), f"search on {resolved.scenario}"
    desired = desired_poses(job.seed, scope, seeds, job.learner.iterations)
    tests = test_poses(job.seed, scope, seeds, job.tests)
    schedule = search.schedule(trials, rules, len(seeds))
    history = train(
        resolved.plant(resolved.controller(), job.seed, [*seeds] * len(trials)),
        HierarchicalLearner(len(trials) * len(seeds), rules, schedule),
        np.tile(desired, (len(trials), 1, 1)),
        np.tile(tests, (len(trials), 1, 1)),
        [job.learner.iterations],
    )
    for column, errors in (
        ("position_error_cm", 100 * history.position),
        ("orientation_error_deg", np.degrees(history.orientation)),
    ):
        by_trial = np.log(errors[:, -1, 0]).reshape(len(trials), len(seeds))
        means = np.exp(by_trial.mean(axis=1))  # geometric, over the seeds
        trials = trials.assign(**{column: [float(f"{mean:.{DIGITS}g}") for mean in means]})
    trials.insert(0, "round", job.round)
    return trials
