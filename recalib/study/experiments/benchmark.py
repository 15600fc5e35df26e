"""What should one use today? Every learner on the same scenarios, in the unit that costs: robot moves."""

import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd

from recalib.errors import UnknownName
from recalib.interfaces import Learner
from recalib.learners import peers
from recalib.nominal.controller import Controller
from recalib.study.experiments import tuned
from recalib.study.experiments.tuned import Training

BLACK_BOX = "measured poses, two moves for each"


class Entrant(NamedTuple):
    """A learner in the benchmark: how it is made, and its iterations and moves."""

    make: Callable[[int, Controller], Learner]
    iterations: int
    moves_per_iteration: int

    def measure_at(self, budgets) -> list[int]:
        """Iterations after which its moves meet one of the budgets."""
        moves = self.moves_per_iteration
        return [
            budget // moves
            for budget in budgets
            if budget % moves == 0 and budget <= self.iterations * moves
        ]


def training_of(name: str, learners: Mapping) -> Training | None:
    """The training of the paper's maps that the name means; None for a peer. Raises UnknownName."""
    if name in peers.NEEDS:
        return None
    try:
        return tuned.training(name, learners)
    except UnknownName as error:
        raise UnknownName("learner", name, [*peers.NEEDS, *error.valid]) from None


def entrant(name: str, config: Mapping) -> Entrant:
    """The learner of this name: a peer, or a training of the paper's maps with the settings found for it.

    Raises UnknownName and InvalidSetting.
    """
    which = training_of(name, config["learners"])
    if which is None:
        return Entrant(partial(peers.build, name), max(config["benchmark"]["moves"]), 1)
    tuned.settings(which, config["tuned"])
    return Entrant(
        lambda runs, _: tuned.build(which, runs, config["learners"], config["tuned"]),
        which.iterations,
        2,
    )


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


def moves_to_reach(history: pd.DataFrame, error: str, threshold: float) -> np.ndarray:
    """For each seed (seed,), the moves of the first measurement within the threshold; infinity where there is none."""
    within = history[history[error] <= threshold].groupby("seed")["moves"].min()
    return (
        within.astype(float)
        .reindex(np.sort(history["seed"].unique()), fill_value=np.inf)
        .to_numpy()
    )
