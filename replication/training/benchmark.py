"""What should one use today? Every learner on the same scenarios, in the unit that costs: moves."""

import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.loop import interfaces
from replication.config.study import LearnerSettings
from replication.scenarios.plants import Resolved
from replication.training.competitors import MOVES, make_peer
from replication.training.poses import Stream, train_for_results
from replication.training.settings import build_tuned


class Timed:
    """A learner whose own time is taken, without that of the robot's moves.

    Attributes:
        seconds: spent in learning so far.
    """

    def __init__(self, learner: interfaces.Learner):
        self._learner, self.seconds = learner, 0.0
        self.command = learner.command

    def learn(self, desired: np.ndarray, execute, fraction: float) -> None:
        """As the learner's own."""
        moving = 0.0

        def timed(commands):
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


def compete(
    scenarios: list[Path],
    name: str,
    rules: LearnerSettings | None,
    seeds: int,
    moves: tuple[int, ...],
    longer: tuple[int, ...],
    tests: int,
    seed: int,
    sample: Path | None = None,
) -> pd.DataFrame:
    """Let a learner work through scenarios, in each of them anew.

    Args:
        scenarios: files of the scenarios as resolved.
        rules: its settings, if it is one of the paper.
        seeds: of each scenario.
        moves: budgets at which it is measured.
        longer: more of them, for a learner of the paper.
        sample: for a learner of the paper, file of the searches for it, whose winners the seeds
            get in turn.

    Returns a row for each scenario, seed and budget of moves.
    """
    runs, frames = range(seeds), []
    iterations, moves_each = (rules.iterations, MOVES) if rules else (max(moves), 1)
    budgets = measured_at([*moves, *longer], iterations, moves_each)
    for scenario in map(Resolved.read, scenarios):
        controller = scenario.controller()
        learner = Timed(
            build_tuned(rules, sample, [run + 1 for run in runs])
            if rules and sample
            else make_peer(name, seeds, controller.robot)
        )
        poses = Stream.SCENARIO.draw(seed, runs, iterations, tests, scenario=scenario.scenario)
        plant = scenario.plant(controller, seed, runs)
        history = train_for_results(plant, learner, poses, budgets)
        frame = pd.DataFrame(history.columns()).rename(columns={"run": "seed"})
        seconds = learner.seconds / (seeds * iterations * moves_each)
        named = {"scenario": scenario.scenario, "learner": name, "seconds_per_move": seconds}
        frames.append(frame.assign(**named))
    return pd.concat(frames, ignore_index=True)
