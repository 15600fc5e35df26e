"""Independent searches for the widths and rates of a training, on poses that nothing else uses."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
from recalib.loop.interfaces import Commandable
from recalib.numerics.randomness import generator
from recalib.study.configuration.study import Budget, LearnerSettings
from recalib.study.experiments import search
from recalib.study.experiments.poses import SearchPoses, Stream, train_on
from recalib.study.experiments.settings import rules_of
from recalib.study.scenarios.plants import Resolved

if TYPE_CHECKING:
    from recalib.learners.radial import RadialLearner

DIGITS = 4  # of errors and scores


def search_for(
    scenario: Path,
    training: str,
    learner: LearnerSettings,
    budget: Budget,
    first: int,
    last: int,
    tests: int,
) -> pd.DataFrame:
    """All trials of some searches, a row each.

    Args:
        first, last: the first of its searches that are done, and one past the last.
    """
    resolved = Resolved.read(scenario)
    controller, seeds = resolved.controller(), [*range(budget.seeds)]
    found = []
    for number in range(first + 1, last + 1):  # nothing is that of another, or of results
        poses = SearchPoses.only(
            Stream.SEARCH.draw(
                budget.seed,
                seeds,
                learner.iterations,
                tests,
                number=number,
                training=training,
                scenario=resolved.scenario,
            )
        )

        def robots(runs: int, stream: str = poses.name) -> Commandable:
            each = seeds * (runs // len(seeds))
            return resolved.plant(controller, budget.seed, each, stream)

        trials = Search(robots, rules_of(learner), budget, poses).all_rounds()
        trials.insert(0, "search", number)
        found.append(trials)
    return pd.concat(found, ignore_index=True)


@dataclass(frozen=True)
class Search:
    """One search: all its trials see the same poses, which nothing else uses.

    Attributes:
        robots: makes as many, for the runs of all seeds of the first trial, then of the next.
        poses: from which a trial learns, and on which it is measured, with each of its seeds.
            Raises TypeError: they are for results. The randomness of trials goes by their name.
        fixed: numbers of a trial that are not sought.
        error: of a pose; see `recalib.nominal.poses.pose_errors`.
    """

    robots: Callable[[int], Commandable]
    rules: Rules
    budget: Budget
    poses: SearchPoses
    fixed: Mapping[str, float] = field(default_factory=dict)
    error: str = "norm"
    learner: "type[HierarchicalLearner | RadialLearner]" = HierarchicalLearner

    def __post_init__(self):
        SearchPoses.only(self.poses)

    def all_rounds(self) -> pd.DataFrame:
        """All trials, round after round, a row each."""
        rounds: list[pd.DataFrame] = []
        for round_ in range(1, self.budget.rounds + 1):
            centre = best_of(pd.concat(rounds, ignore_index=True)) if rounds else None
            random = generator(self.budget.seed, self.poses.name, "trials", round_)
            trials = self._tried(self._drawn(random, centre))
            trials.insert(0, "round", round_)
            rounds.append(trials)
        return pd.concat(rounds, ignore_index=True)

    def further(self, start: Mapping) -> pd.DataFrame:
        """A trial, and others around it: as many as a round has, all in all."""
        random = generator(self.budget.seed, self.poses.name, "further trials")
        around = self._drawn(random, start)
        first = pd.DataFrame([{column: start[column] for column in around}])
        return self._tried(pd.concat([first, around.iloc[:-1]], ignore_index=True))

    def _drawn(self, random: np.random.Generator, around: Mapping | None) -> pd.DataFrame:
        ranges, count = dict(self.budget.ranges), self.budget.trials
        return search.draw(self.rules, ranges, count, random, around).assign(**self.fixed)

    def _tried(self, trials: pd.DataFrame) -> pd.DataFrame:
        """The trials with their errors and scores."""
        seeds, iterations, _ = self.poses.desired.shape
        runs = len(trials) * seeds
        desired, tests = (
            np.tile(poses, (len(trials), 1, 1)) for poses in (self.poses.desired, self.poses.tests)
        )
        history = train_on(
            self.robots(runs),
            self.learner(self.rules, search.schedule(trials, self.rules, seeds), runs=runs),
            replace(self.poses, desired=desired, tests=tests),
            [iterations],
            error=self.error,
        )
        for column, errors in (
            ("position_error_cm", 100 * history.position),
            ("orientation_error_deg", np.degrees(history.orientation)),
        ):
            by_trial = np.log(errors[:, -1, 0]).reshape(len(trials), seeds)
            trials[column] = _short(np.exp(by_trial.mean(axis=1)))  # geometric, over the seeds
        trials["score"] = _short(search.scores(trials, self.budget))
        return trials


def best_of(trials: pd.DataFrame) -> pd.Series:
    """The trial of one search that it keeps."""
    return trials.loc[trials["score"].idxmin()]


def _short(values: Iterable[float]) -> list[float]:
    """Values with so few digits that every machine writes the same."""
    return [float(f"{value:.{DIGITS}g}") for value in values]
