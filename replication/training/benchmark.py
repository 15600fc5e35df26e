"""What should one use today? Every learner on the same scenarios, in the unit that costs: moves."""

import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.loop import interfaces
from replication.config.study import Study
from replication.scenarios.resolving import resolve
from replication.training.competitors import MOVES, make_peer
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


class Timed:
    """A learner whose own time is taken, without that of the robot's moves.

    Attributes:
        seconds: spent in learning so far.
    """

    def __init__(self, learner: interfaces.Learner):
        self._learner, self.seconds = learner, 0.0
        self.command = learner.command

    def learn(self, desired: np.ndarray, execute: interfaces.Execute, fraction: float) -> None:
        """As the learner's own."""
        moving = 0.0

        def timed(commands: np.ndarray) -> interfaces.Outcome:
            nonlocal moving
            start = time.perf_counter()
            outcome = execute(commands)
            moving += time.perf_counter() - start
            return outcome

        start = time.perf_counter()
        self._learner.learn(desired, timed, fraction)
        self.seconds += time.perf_counter() - start - moving


def measured_at(budgets: Sequence[int], iterations: int, moves: int) -> list[int]:
    """Iterations, of so many moves each, after which the moves meet one of the budgets."""
    met = (budget for budget in budgets if budget % moves == 0)
    return [budget // moves for budget in met if budget <= iterations * moves]


def compete(study: Study, learner: str, settings: Sequence[Path]) -> pd.DataFrame:
    """Let a learner work through the scenarios of the benchmark, in each of them anew.

    Args:
        settings: files with widths and rates, for a learner of the paper.

    Returns a row for each scenario, seed and budget of moves.
    """
    plan, runs, frames = study.benchmark, range(study.benchmark.seeds), []
    papers = learner in plan.papers
    moves_each = MOVES if papers else 1
    iterations = plan.papers[learner] if papers else max(plan.moves)
    budgets = measured_at([*plan.moves, *plan.longer], iterations, moves_each)
    for scenario in resolve(study, study.robot, plan.scenarios)[0]:
        controller = scenario.controller()
        its = Timed(
            Tuned(study, settings).learner(learner, iterations, plan.seeds)
            if papers
            else make_peer(learner, plan.seeds, controller.robot)
        )
        poses = Stream.SCENARIO.draw(
            study.seed, runs, iterations, study.training.tests, scenario=scenario.scenario
        )
        plant = scenario.plant(controller, study.seed, runs)
        history = train_for_results(plant, its, poses, budgets)
        frame = pd.DataFrame(history.columns()).rename(columns={"run": "seed"})
        seconds = its.seconds / (plan.seeds * iterations * moves_each)
        named = {"scenario": scenario.scenario, "learner": learner, "seconds_per_move": seconds}
        frames.append(frame.assign(**named))
    return pd.concat(frames, ignore_index=True)
