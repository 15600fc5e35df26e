"""What should one use today? Every learner on the same scenarios, in the unit that costs: moves."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.interfaces import Learner
from recalib.study import jobs
from recalib.study.entrants import MOVES, make_peer
from recalib.study.experiments.poses import ResultPoses, Stream, train_for_results
from recalib.study.experiments.settings import build_tuned
from recalib.study.plants import Resolved, fleet
from recalib.study.progress import progress_bar

if TYPE_CHECKING:
    import pandas as pd


class Timed:
    """A learner whose own time is taken, without that of the robot's moves.

    Attributes:
        seconds: spent in learning so far.
    """

    def __init__(self, learner: Learner):
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
    job: jobs.Benchmark, scenarios: Sequence[str | Path], sample: str | Path | None = None
) -> "pd.DataFrame":
    """Let a learner work through scenarios of one robot side by side.

    Args:
        scenarios: files of the scenarios as resolved.
        sample: for a learner of the paper, file of the searches for it, whose winners the seeds
            get in turn.

    Returns a row for each scenario, seed and budget of moves.
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    runs, total = range(job.seeds), len(scenarios) * job.seeds
    controller, plants = fleet([Resolved.read(path) for path in scenarios], job.seed, runs)
    if job.learner is None:
        iterations, moves = max(job.moves), 1
        learner = Timed(make_peer(job.name, total, controller))
    else:
        iterations, moves = job.learner.iterations, MOVES
        searches = [run + 1 for run in runs] * len(scenarios)
        learner = Timed(build_tuned(job.learner, sample, searches))
    poses = ResultPoses.side_by_side(
        Stream.SCENARIO.draw(job.seed, runs, iterations, job.tests, scenario=scenario)
        for scenario in job.scenarios
    )
    budgets = measured_at([*job.moves, *job.longer], iterations, moves)
    with progress_bar(f"{job.name} on {', '.join(job.scenarios)}", iterations) as progress:
        history = train_for_results(plants, learner, poses, budgets, progress=progress)
    frame = pd.DataFrame(history.columns()).rename(columns={"run": "seed"})
    return frame.assign(
        scenario=np.array(job.scenarios)[frame["seed"] // len(runs)],
        seed=frame["seed"] % len(runs),
        learner=job.name,
        seconds_per_move=learner.seconds / (total * iterations * moves),
    )
