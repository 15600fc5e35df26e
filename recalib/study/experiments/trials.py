"""Independent searches for the widths and rates of a training, on poses that nothing else uses."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.experiments import search
from recalib.study.experiments.campaign import desired_poses, test_poses
from recalib.study.experiments.settings import best, rules_of
from recalib.study.plants import Resolved
from recalib.training import train

DIGITS = 4  # of an error, so that the files that keep it are the same on every machine


def search_for(job: jobs.Searches, scenario: str | Path) -> pd.DataFrame:
    """All trials of some searches, a row each.

    Args:
        scenario: file of the scenario as resolved.
    """
    resolved = Resolved.read(scenario)
    controller, seeds = resolved.controller(), [*range(job.budget.seeds)]

    def plant(runs: int) -> Plant:
        return resolved.plant(controller, job.budget.seed, seeds * (runs // len(seeds)))

    searches = range(job.first + 1, job.last + 1)
    found = []
    for number in searches:
        # as a scope of randomness: nothing of a search is that of another one, or of a training
        luck = f"search {number} for {job.training} on {resolved.scenario}"
        desired = desired_poses(job.budget.seed, luck, seeds, job.learner.iterations)
        tests = test_poses(job.budget.seed, luck, seeds, job.tests)
        trials = _search(job, luck, plant, desired, tests)
        trials.insert(0, "search", number)
        found.append(trials)
    return pd.concat(found, ignore_index=True)


def _search(job: jobs.Searches, luck: str, plant, desired, tests) -> pd.DataFrame:
    """One search, round after round."""
    rules, budget = rules_of(job.learner), job.budget
    rounds: list[pd.DataFrame] = []
    for round_ in range(1, budget.rounds + 1):
        centre = best(pd.concat(rounds)) if rounds else None
        random = generator(budget.seed, luck, "trials", round_)
        trials = search.draw(rules, dict(budget.ranges), budget.trials, random, centre)
        errors = _errors(job, trials, plant, desired, tests)
        trials = trials.assign(**errors)
        trials.insert(0, "round", round_)
        rounds.append(trials)
    return pd.concat(rounds)


def _errors(job: jobs.Searches, trials: pd.DataFrame, plant, desired, tests) -> Mapping:
    """The errors of trials, each their geometric mean over the seeds."""
    rules, seeds = rules_of(job.learner), job.budget.seeds
    runs = len(trials) * seeds
    history = train(
        plant(runs),
        HierarchicalLearner(runs, rules, search.schedule(trials, rules, seeds)),
        np.tile(desired, (len(trials), 1, 1)),
        np.tile(tests, (len(trials), 1, 1)),
        [job.learner.iterations],
    )
    errors = {}
    for column, measured in (
        ("position_error_cm", 100 * history.position),
        ("orientation_error_deg", np.degrees(history.orientation)),
    ):
        by_trial = np.log(measured[:, -1, 0]).reshape(len(trials), seeds)
        means = np.exp(by_trial.mean(axis=1))
        errors[column] = [float(f"{mean:.{DIGITS}g}") for mean in means]
    return errors
