"""Do wide neighbourhoods learn a coarse mapping in few iterations (section 6)?

The improved system learns with constant widths and rates. Each width has its best rate out of a
few, chosen on other poses.
"""

import numpy as np
import pandas as pd

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule
from replication.config.study import Measuring
from replication.scenarios.plants import Resolved
from replication.training.poses import ResultPoses, SearchPoses, Stream, train_on

# Half of the workspace, and half of the distance between cells, so that neighbours hardly learn.
WIDTHS = {"wide": 1.0, "narrow": 1 / 3}
RATES = np.array([0.1, 0.2, 0.4, 0.8])
LEFT = 0.5  # remaining share of both errors after which a mapping is coarsely learned
ITERATIONS, SEEDS = 1000, 10
MEASURING = Measuring(tests=50, measure_every=1, measure_evenly=1, measurements=60)


def halved_after(
    resolved: Resolved,
    rules: Rules,
    width: float,
    rates: np.ndarray,
    poses: SearchPoses | ResultPoses,
    seed: int,
) -> np.ndarray:
    """Iterations (run,) after which both errors are halved; all iterations if they never are.

    Each run has its own learning rate, in `rates` (run,); `seed` is the robots' seed.
    """
    schedule = Schedule(width, dict.fromkeys(rules.maps, (width, width)), rates, rates)
    learner = HierarchicalLearner(rules, schedule, runs=len(rates))
    plant = resolved.plant(resolved.controller(), seed, range(len(rates)))
    history = train_on(plant, learner, poses, MEASURING.during(poses.desired.shape[1]))
    errors = np.stack([history.position_error, history.orientation_error])
    halved = np.all(errors <= LEFT * errors[..., :1], axis=0)
    return np.where(
        halved.any(axis=1), history.iterations[halved.argmax(axis=1)], history.iterations[-1]
    )


def constant_widths(resolved: Resolved, rules: Rules, seed: int) -> pd.DataFrame:
    """A row for each width and seed, with columns width, rate, seed and iterations."""
    trials, tables = np.repeat(RATES, SEEDS), []
    for name, width in WIDTHS.items():
        searched = Stream.RATES.draw(
            seed, range(len(trials)), ITERATIONS, MEASURING.tests, widths=name
        )
        found = halved_after(resolved, rules, width, trials, searched, seed)
        rate = RATES[np.log(found).reshape(len(RATES), SEEDS).mean(axis=1).argmin()]
        poses = Stream.WIDTHS.draw(seed, range(SEEDS), ITERATIONS, MEASURING.tests)
        iterations = halved_after(resolved, rules, width, np.full(SEEDS, rate), poses, seed)
        columns = {"width": name, "rate": rate, "seed": range(SEEDS), "iterations": iterations}
        tables.append(pd.DataFrame(columns))
    return pd.concat(tables)
