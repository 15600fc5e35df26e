"""A replicate of an alternative setup: where its learners are tuned, trained and measured.

Nothing of a replicate is that of another one: searches, poses and seeds are its own. Learners that
are compared in it see the same poses.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from recalib.damaged.damage import apply
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
from recalib.study.configuration.damages import damages_among
from recalib.study.experiments import search
from recalib.study.experiments.poses import SearchPoses, Stream, train_for_results
from recalib.study.experiments.settings import rules_of
from recalib.study.experiments.trials import Search, best_of
from recalib.study.multiverse.universe import Universe
from recalib.study.scenarios.plants import nominal_controller

if TYPE_CHECKING:
    from recalib.learners.radial import RadialLearner

    Kind = type[HierarchicalLearner | RadialLearner]


def rules_in(universe: Universe, learner: str) -> Rules:
    """The rules of one of its learners; how its rate falls goes with how its widths fall."""
    rules = rules_of(universe.learners[learner])
    return replace(
        rules,
        **universe.conventions.model_dump(),
        rate=universe.rate_of_visits if rules.equal_visits else universe.ritters_rate,
    )


class World:
    """A replicate of a setup, the first one with number 0."""

    def __init__(self, universe: Universe, replicate: int):
        self.universe, self.replicate = universe, replicate
        self.controller = nominal_controller(universe.nominal)

    def arm(self, scenario: str):
        """The arm with the damage of a scenario."""
        return apply(self.controller.robot, damages_among(self.universe.scenarios[scenario]))

    def search(
        self,
        learner: str,
        iterations: int,
        like: str = "",
        fixed: Mapping[str, float] = {},
        kind: "Kind" = HierarchicalLearner,
    ) -> Search:
        """The search for a learner, on the paper's damage.

        Args:
            like: learner whose search had the same poses; its own unless given.
            fixed: numbers of a trial that are not sought.
        """
        universe, arm = self.universe, self.arm(self.universe.own)
        poses = Stream.SEARCH_OF_REPLICATE.draw(
            universe.budget.seed,
            range(universe.budget.seeds),
            iterations,
            universe.tests,
            universe.order,
            training=f"{like or learner}_{iterations}",
            replicate=self.replicate,
        )
        return Search(
            robots=lambda runs: Plant(self.controller, arm),
            rules=rules_in(universe, learner),
            budget=universe.budget,
            poses=SearchPoses.only(poses),
            fixed=fixed,
            error=universe.error,
            learner=kind,
        )

    def train(
        self,
        learner: str,
        iterations: int,
        trials: pd.DataFrame,
        scenario: str = "",
        kind: "Kind" = HierarchicalLearner,
    ) -> np.ndarray:
        """First and last errors (seed, 2, 2) [cm, degrees] of the best of some trials.

        On the paper's damage, or another scenario.
        """
        universe, seeds = self.universe, range(self.universe.seeds)
        arm, rules = self.arm(scenario or universe.own), rules_in(universe, learner)
        poses = Stream.REPLICATE.draw(
            universe.seed,
            seeds,
            iterations,
            universe.tests,
            universe.order,
            replicate=self.replicate,
        )
        history = train_for_results(
            Plant(self.controller, arm),
            kind(rules, search.schedule(best_of(trials), rules), runs=len(seeds)),
            poses,
            [0, iterations],
            error=universe.error,
        )
        return np.stack(
            [100 * history.position[..., 0], np.degrees(history.orientation[..., 0])], axis=-1
        )

    def tuned(self, learner: str, iterations: int) -> np.ndarray:
        """Final errors (seed, 2) [cm, degrees] of a learner tuned for so many iterations."""
        trials = self.search(learner, iterations).all_rounds()
        return self.train(learner, iterations, trials)[:, -1]
