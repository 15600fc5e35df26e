"""Independent searches for the widths and rates of a training, on poses that nothing else uses."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.interfaces import Commandable
from recalib.learners.hierarchical import HierarchicalLearner, Rules
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.configuration.study import Budget
from recalib.study.experiments import search
from recalib.study.experiments.campaign import desired_poses, test_poses
from recalib.study.experiments.settings import rules_of
from recalib.study.plants import Resolved
from recalib.training import train

if TYPE_CHECKING:
    import pandas as pd

DIGITS = 4  # of errors and scores


def search_for(job: jobs.Searches, scenario: str | Path) -> "pd.DataFrame":
    """All trials of some searches, a row each.

    Args:
        scenario: file of the scenario as resolved.
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    resolved = Resolved.read(scenario)
    controller, seeds = resolved.controller(), [*range(job.budget.seeds)]

    def robots(runs: int) -> Commandable:
        return resolved.plant(controller, job.budget.seed, seeds * (runs // len(seeds)))

    found = []
    for number in range(job.first + 1, job.last + 1):
        # nothing of a search is that of another one, or of a training
        luck = f"search {number} for {job.training} on {resolved.scenario}"
        rules, iterations = rules_of(job.learner), job.learner.iterations
        trials = search_once(robots, rules, iterations, job.budget, job.tests, luck)
        trials.insert(0, "search", number)
        found.append(trials)
    return pd.concat(found, ignore_index=True)


def search_once(
    robots: Callable[[int], Commandable],
    rules: Rules,
    iterations: int,
    budget: Budget,
    tests: int,
    luck: str,
    error: str = "norm",
    order: str = "random",
) -> "pd.DataFrame":
    """All trials of one search, round after round, a row each.

    Args:
        robots: makes as many, for the runs of all seeds of the first trial, then of the next.
        iterations: of a training.
        tests: poses on which a trial is measured.
        luck: the scope of its randomness.
        error: of a pose; see `recalib.nominal.poses.pose_errors`.
        order: of the poses; see `desired_poses`.
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    seeds = range(budget.seeds)
    poses = desired_poses(budget.seed, luck, seeds, iterations, order)
    tested = test_poses(budget.seed, luck, seeds, tests)
    rounds: list[pd.DataFrame] = []
    for round_ in range(1, budget.rounds + 1):
        so_far = pd.concat(rounds, ignore_index=True) if rounds else None
        centre = None if so_far is None else so_far.loc[so_far["score"].idxmin()]
        random = generator(budget.seed, luck, "trials", round_)
        trials = search.draw(rules, dict(budget.ranges), budget.trials, random, centre)
        runs = len(trials) * len(seeds)
        history = train(
            robots(runs),
            HierarchicalLearner(runs, rules, search.schedule(trials, rules, len(seeds))),
            np.tile(poses, (len(trials), 1, 1)),
            np.tile(tested, (len(trials), 1, 1)),
            [iterations],
            error=error,
        )
        for column, errors in (
            ("position_error_cm", 100 * history.position),
            ("orientation_error_deg", np.degrees(history.orientation)),
        ):
            by_trial = np.log(errors[:, -1, 0]).reshape(len(trials), len(seeds))
            trials[column] = _short(np.exp(by_trial.mean(axis=1)))  # geometric, over the seeds
        trials["score"] = _short(search.scores(trials, budget))
        trials.insert(0, "round", round_)
        rounds.append(trials)
    return pd.concat(rounds, ignore_index=True)


def _short(values: Iterable[float]) -> list[float]:
    """Values with so few digits that every machine writes the same."""
    return [float(f"{value:.{DIGITS}g}") for value in values]
