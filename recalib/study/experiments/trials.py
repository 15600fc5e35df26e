"""Independent searches for the widths and rates of a training, on poses that nothing else uses."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.interfaces import Commandable
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
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

    from recalib.learners.radial import RadialLearner

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
        scope = f"search {number} for {job.training} on {resolved.scenario}"
        rules, iterations = rules_of(job.learner), job.learner.iterations
        trials = Search(robots, rules, iterations, job.budget, job.tests, scope).all_rounds()
        trials.insert(0, "search", number)
        found.append(trials)
    return pd.concat(found, ignore_index=True)


@dataclass(frozen=True)
class Search:
    """One search: all its trials see the same poses, which nothing else uses.

    Attributes:
        robots: makes as many, for the runs of all seeds of the first trial, then of the next.
        rules: of the learner.
        iterations: of a training.
        budget: what it may spend.
        tests: poses on which a trial is measured.
        scope: of its randomness.
        fixed: numbers of a trial that are not sought.
        error: of a pose; see `recalib.nominal.poses.pose_errors`.
        order: of the poses to learn from; see `desired_poses`.
        learner: its kind.
    """

    robots: Callable[[int], Commandable]
    rules: Rules
    iterations: int
    budget: Budget
    tests: int
    scope: str
    fixed: Mapping[str, float] = field(default_factory=dict)
    error: str = "norm"
    order: str = "random"
    learner: "type[HierarchicalLearner | RadialLearner]" = HierarchicalLearner

    def all_rounds(self) -> "pd.DataFrame":
        """All trials, round after round, a row each."""
        import pandas as pd  # a quarter of a second: no start waits for it

        rounds: list[pd.DataFrame] = []
        for round_ in range(1, self.budget.rounds + 1):
            centre = best_of(pd.concat(rounds, ignore_index=True)) if rounds else None
            random = generator(self.budget.seed, self.scope, "trials", round_)
            trials = self._tried(self._drawn(random, centre))
            trials.insert(0, "round", round_)
            rounds.append(trials)
        return pd.concat(rounds, ignore_index=True)

    def further(self, start: Mapping) -> "pd.DataFrame":
        """A trial, and others around it: as many as a round has, all in all."""
        import pandas as pd

        random = generator(self.budget.seed, self.scope, "further trials")
        around = self._drawn(random, start)
        first = pd.DataFrame([{column: start[column] for column in around}])
        return self._tried(pd.concat([first, around.iloc[:-1]], ignore_index=True))

    def _drawn(self, random: np.random.Generator, around: Mapping | None) -> "pd.DataFrame":
        ranges, count = dict(self.budget.ranges), self.budget.trials
        return search.draw(self.rules, ranges, count, random, around).assign(**self.fixed)

    def _tried(self, trials: "pd.DataFrame") -> "pd.DataFrame":
        """The trials with their errors and scores."""
        seeds = range(self.budget.seeds)
        poses = desired_poses(self.budget.seed, self.scope, seeds, self.iterations, self.order)
        tested = test_poses(self.budget.seed, self.scope, seeds, self.tests)
        runs = len(trials) * len(seeds)
        history = train(
            self.robots(runs),
            self.learner(self.rules, search.schedule(trials, self.rules, len(seeds)), runs=runs),
            np.tile(poses, (len(trials), 1, 1)),
            np.tile(tested, (len(trials), 1, 1)),
            [self.iterations],
            error=self.error,
        )
        for column, errors in (
            ("position_error_cm", 100 * history.position),
            ("orientation_error_deg", np.degrees(history.orientation)),
        ):
            by_trial = np.log(errors[:, -1, 0]).reshape(len(trials), len(seeds))
            trials[column] = _short(np.exp(by_trial.mean(axis=1)))  # geometric, over the seeds
        trials["score"] = _short(search.scores(trials, self.budget))
        return trials


def best_of(trials: "pd.DataFrame") -> "pd.Series":
    """The trial of one search that it keeps."""
    return trials.loc[trials["score"].idxmin()]


def _short(values: Iterable[float]) -> list[float]:
    """Values with so few digits that every machine writes the same."""
    return [float(f"{value:.{DIGITS}g}") for value in values]
