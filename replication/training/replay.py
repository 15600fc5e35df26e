"""Does learning leave the controller untouched (section 8)? A robot and a table teach a learner."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from recalib.files.archives import flat
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.loop.interfaces import Outcome
from replication.scenarios.plants import Resolved
from replication.training.poses import Stream


def replay(
    resolved: Resolved, make_learner: Callable[[], HierarchicalLearner], iterations: int, seed: int
) -> pd.DataFrame:
    """The largest difference in each learned array: learned from a robot, or from a table."""
    plant = resolved.plant(resolved.controller(), seed, [0])
    desired = Stream.REPLAY.draw(seed, [0], iterations, tests=0).desired
    table: dict[bytes, Outcome] = {}

    def by_robot(commands: np.ndarray) -> Outcome:
        table[commands.tobytes()] = plant.execute(commands)
        return table[commands.tobytes()]

    def by_table(commands: np.ndarray) -> Outcome:
        return table[commands.tobytes()]  # KeyError: a command that was never sent

    learned = []
    for execute in (by_robot, by_table):
        learner = make_learner()
        for iteration in range(iterations):
            learner.learn(desired[:, iteration], execute, iteration / iterations)
        learned.append(flat(learner.state()[0]))
    first, second = learned
    return pd.DataFrame(
        [
            {"array": name, "difference": np.abs(second[name] - values).max()}
            for name, values in first.items()
        ]
    )
