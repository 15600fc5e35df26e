"""What a search tries: learners with other widths and rates, side by side on the same poses."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.radial import RadialLearner
from recalib.learners.uncorrected import UncorrectedLearner
from recalib.loop.interfaces import Commandable
from recalib.loop.training import measure
from replication.training.poses import ResultPoses, SearchPoses, train_on
from replication.training.settings import Space

NEGLIGIBLE = 1e-9  # m, rad: an error of an arm that has none, of this kind
Kind = type[HierarchicalLearner] | type[RadialLearner]


class Outcome(NamedTuple):
    """What trials leave.

    Attributes:
        errors: (trial, run, 2) mean position [m] and orientation errors [rad] after training.
        refused: (trial, run) moves that the controller refused.
    """

    errors: np.ndarray
    refused: np.ndarray


@dataclass(frozen=True)
class Trials:
    """Trainings of a learner that differ in their settings alone.

    Attributes:
        space: of the settings that are tried, with the learner's rules.
        poses: from which each trial learns, and on which it is measured, in each of its runs.
        robots: makes as many damaged robots, for all runs of the first trial, then of the next.
        error: of a pose; see `recalib.nominal.poses.pose_errors`.
        learner: the class of the learner.
    """

    space: Space
    poses: SearchPoses | ResultPoses
    robots: Callable[[int], Commandable]
    error: str = "norm"
    learner: Kind = HierarchicalLearner

    def first(self, runs: int) -> "Trials":
        """The same in the first of its runs alone."""
        desired, tests = self.poses.desired[:runs], self.poses.tests[:runs]
        return replace(self, poses=replace(self.poses, desired=desired, tests=tests))

    def outcome(self, rows: np.ndarray) -> Outcome:
        """What is left after training with these settings.

        Args:
            rows: (trial, column) settings; see `replication.training.settings`.
        """
        trials, (runs, iterations, _) = len(rows), self.poses.desired.shape
        desired, tests = (
            np.tile(poses, (trials, 1, 1)) for poses in (self.poses.desired, self.poses.tests)
        )
        schedule = self.space.schedule(np.repeat(rows, runs, axis=0))
        learner = self.learner(self.space.rules, schedule, runs=trials * runs)
        plant = self.robots(trials * runs)
        poses = replace(self.poses, desired=desired, tests=tests)
        history = train_on(plant, learner, poses, [iterations], error=self.error)
        errors = np.stack([history.position_error, history.orientation_error], axis=-1)[:, -1]
        return Outcome(errors.reshape(trials, runs, 2), history.refused.reshape(trials, runs))

    def shares(self, rows: np.ndarray) -> np.ndarray:
        """Which share of the arm's own errors remains after training (trial, 2).

        Of position and of orientation errors, geometric means over the runs.
        """
        uncorrected = np.where(self.uncorrected > NEGLIGIBLE, self.uncorrected, np.inf)
        shares = self.outcome(rows).errors / uncorrected
        shares[~np.isfinite(shares)] = np.inf  # of a learner that diverges
        with np.errstate(divide="ignore"):
            found: np.ndarray = np.exp(np.log(shares).mean(axis=1))
        return found

    @cached_property
    def uncorrected(self) -> np.ndarray:
        """Errors (run, 2) [m, rad] where poses are commanded as desired."""
        tests = self.poses.tests
        both = measure(self.robots(len(tests)), UncorrectedLearner(), tests, self.error)
        return np.stack([error[:, 0] for error in both], axis=-1)
