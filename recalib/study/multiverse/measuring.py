"""What is measured in a universe: all of the claims that can vary, as at home, each by one number.

Luck is new in every universe: of the searches, of the poses and of the seeds.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from recalib.damaged.damage import apply
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.study.configuration.damages import damages_among
from recalib.study.configuration.study import Budget
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.evidence.claims import rigid
from recalib.study.evidence.speedup import iterations_needed
from recalib.study.experiments import search
from recalib.study.experiments.campaign import desired_poses, test_poses
from recalib.study.experiments.trials import search_once
from recalib.study.measured import ERRORS, KINDS
from recalib.study.multiverse.rules import rules_in
from recalib.study.multiverse.universe import Universe
from recalib.study.plants import nominal_controller
from recalib.study.statistics import combined
from recalib.training import train

if TYPE_CHECKING:
    import pandas as pd

PARTS = (0, 0.1, 0.25, 0.5, 1)  # of a training, after which it is measured


class World:
    """A universe in which learners can be tuned and trained.

    Args:
        universe: which.
    """

    def __init__(self, universe: Universe):
        self.universe = universe
        self._controller = nominal_controller(universe.nominal)

    def robots(self, scenario: str) -> Callable[[int], Plant]:
        """Makes as many as there are runs, all with the damage of a scenario."""
        damages = damages_among(self.universe.scenarios[scenario])
        arm = apply(self._controller.robot, damages)
        return lambda runs: Plant(self._controller, [arm])

    def tune(self, learner: str, iterations: int, budget: Budget) -> "pd.DataFrame":
        """All trials of the search for a learner, on the paper's damage."""
        rules, robots = rules_in(self.universe, learner), self.robots(self.universe.own)
        luck = f"search for {learner}_{iterations}"
        return search_once(robots, rules, iterations, budget, self.universe.tests, luck)

    def train(
        self, learner: str, iterations: int, trials: "pd.DataFrame", scenario: str = ""
    ) -> np.ndarray:
        """Errors (seed, measurement, 2) [cm, degrees] of the best of some trials.

        Args:
            scenario: the paper's damage unless given.
        """
        universe, seeds = self.universe, range(self.universe.seeds)
        rules = rules_in(universe, learner)
        best = trials.loc[trials["score"].idxmin()]
        history = train(
            self.robots(scenario or universe.own)(len(seeds)),
            HierarchicalLearner(len(seeds), rules, search.schedule(best, rules)),
            desired_poses(universe.seed, "universe", seeds, iterations),
            test_poses(universe.seed, "universe", seeds, universe.tests),
            sorted({round(part * iterations) for part in PARTS}),
        )
        return np.stack(
            [100 * history.position[..., 0], np.degrees(history.orientation[..., 0])], axis=-1
        )


def measure(universe: Universe) -> dict[str, float]:
    """A row of the table of outcomes: see the claims for what is compared with what."""
    world, iterations = World(universe), universe.learners[IMPROVED].iterations
    trials = {name: world.tune(name, iterations, universe.budget) for name in universe.learners}
    errors = {name: world.train(name, iterations, its) for name, its in trials.items()}

    row = {}
    for moment, when in (("initial", 0), ("final", -1)):
        for error, value in zip(ERRORS, errors[IMPROVED][:, when].mean(axis=0), strict=True):
            row[f"{moment}_{error}"] = value
    row["left"] = _left(errors[IMPROVED]).max()
    row["ritter_left"] = _left(errors[RITTER]).min()
    for switch in SWITCHES:
        row[f"{switch.key}_improved"] = _ratio(errors[IMPROVED], errors[switch.without])
        row[f"{switch.key}_ritter"] = _ratio(errors[switch.added], errors[RITTER])
    row["factor"] = _factor(world)
    moved = (world.train(IMPROVED, iterations, trials[IMPROVED], each) for each in rigid.SCENARIOS)
    row["rigid_left"] = max(_left(each).max() for each in moved)
    row["intact"] = world.train(IMPROVED, iterations, trials[IMPROVED], "intact").max()
    row["width_order"] = _width_order(trials[IMPROVED])
    return row


def _left(errors: np.ndarray) -> np.ndarray:
    """What is left of both errors (2,), geometric means over the seeds.

    Of an error that is zero to begin with nothing is asked here.
    """
    there = errors[:, 0].min(axis=0) > rigid.NONE
    first, last = errors[:, 0, there], errors[:, -1, there]
    return np.exp(np.log(last / first).mean(axis=0))


def _ratio(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Our error over theirs, the geometric mean over the seeds."""
    logs = (np.log(combined(errors[:, -1])) for errors in (ours, theirs))
    return float(np.exp(np.subtract(*logs).mean()))


def _width_order(trials: "pd.DataFrame") -> float:
    """Narrow over wide, as section 4 has them, in the map that shows it less.

    Of the best tenth of the first round, as in the claim.
    """
    first = trials[trials["round"] == 1]
    best = first.nsmallest(-(-len(first) // 10), "score")
    ratios = [np.exp(np.log(best[f"{kind}/g_k"] / best[f"{kind}/g_kl"]).mean()) for kind in KINDS]
    return float(max(ratios[0], 1 / ratios[1]))


def _factor(world: World) -> float:
    """How many times as many iterations Ritter's needs as the improved one, both tuned alike.

    Rungs are tried from the middle one, up to the first that reaches the errors of the improved
    system, or down to the first that does not. Infinite where none reaches them; where the lowest
    does, what it says is too much.
    """
    universe = world.universe
    own = universe.learners[IMPROVED].iterations
    goal = _tuned(world, IMPROVED, own)
    rungs, found = universe.rungs, {}
    rung = len(rungs) // 2
    while 0 <= rung < len(rungs) and rung not in found:
        found[rung] = _tuned(world, RITTER, rungs[rung])
        rung += -1 if (found[rung] <= goal).all() else 1
    tried = sorted(found)
    grid, errors = np.array([rungs[rung] for rung in tried]), np.array([found[r] for r in tried])
    needed = float(iterations_needed(grid, errors, goal))
    return (rungs[0] if np.isnan(needed) else needed) / own


def _tuned(world: World, name: str, iterations: int) -> np.ndarray:
    """Final errors (2,) of a learner after a rough search: long trainings allow no other."""
    trials = world.tune(name, iterations, world.universe.rough)
    return world.train(name, iterations, trials)[:, -1].mean(axis=0)
