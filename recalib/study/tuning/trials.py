"""What a search tries: learners with other widths and rates, side by side on the same poses."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.radial import RadialLearner
from recalib.learners.rules import Rules
from recalib.learners.uncorrected import UncorrectedLearner
from recalib.loop.interfaces import Commandable
from recalib.loop.training import measure
from recalib.study.experiments.poses import SearchPoses, train_on
from recalib.study.tuning.settings import schedule

NEGLIGIBLE = 1e-9  # m, rad: an error of an arm that has none, of this kind


@dataclass(frozen=True)
class Trials:
    """Trainings of a learner that differ in their settings alone.

    Attributes:
        rules: of the learner.
        poses: from which each trial learns, and on which it is measured, in each of its runs.
        robots: makes as many damaged robots, for all runs of the first trial, then of the next.
        error: of a pose; see `recalib.nominal.poses.pose_errors`.
        learner: the class of the learner.
    """

    rules: Rules
    poses: SearchPoses
    robots: Callable[[int], Commandable]
    error: str = "norm"
    learner: type[HierarchicalLearner] | type[RadialLearner] = HierarchicalLearner

    def shares(self, settings: np.ndarray) -> np.ndarray:
        """Which share of the arm's own errors remains after training (trial, 2).

        Of position and of orientation errors, geometric means over the runs.

        Args:
            settings: (trial, d) rows; see `recalib.study.tuning.settings`.
        """
        trials, (runs, iterations, _) = len(settings), self.poses.desired.shape
        desired, tests = (
            np.tile(poses, (trials, 1, 1)) for poses in (self.poses.desired, self.poses.tests)
        )
        learner = self.learner(
            self.rules, schedule(np.repeat(settings, runs, axis=0), self.rules), runs=trials * runs
        )
        plant = self.robots(trials * runs)
        poses = replace(self.poses, desired=desired, tests=tests)
        history = train_on(plant, learner, poses, [iterations], error=self.error)
        errors = np.stack([history.position_error, history.orientation_error], axis=-1)[:, -1]
        shares = errors.reshape(trials, runs, 2) / self._uncorrected
        shares[~np.isfinite(shares)] = np.inf  # of a learner that diverges
        with np.errstate(divide="ignore"):
            found: np.ndarray = np.exp(np.log(shares).mean(axis=1))
        return found

    @cached_property
    def _uncorrected(self) -> np.ndarray:
        """Errors (run, 2) where poses are commanded as desired; infinite for one that is none."""
        tests = self.poses.tests
        both = measure(self.robots(len(tests)), UncorrectedLearner(), tests, self.error)
        errors = np.stack([error[:, 0] for error in both], axis=-1)
        return np.where(errors > NEGLIGIBLE, errors, np.inf)
