"""How many times as many iterations Ritter's needs in a setup as the improved system.

Both are sought with the setup's own effort, anew for each number of iterations.
"""

import numpy as np

from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.evidence.speedup import iterations_needed
from recalib.study.multiverse.universe import Universe
from recalib.study.multiverse.world import World


def horizon(universe: Universe) -> list[dict[str, float]]:
    """A row for each replicate of a setup: see `_factor`."""
    return [
        {"universe": universe.number, "replicate": replicate} | _factor(World(universe, replicate))
        for replicate in range(universe.replicates)
    ]


def _factor(world: World) -> dict[str, float]:
    """The `factor`, and whether it is a `bound`: -1, it is at most that; 1, at least; 0, neither.

    Rungs are tried from the middle one, up to the first that reaches the errors of the improved
    system, or down to the first that does not. Where none of them does the one or the other, the
    last rung is a bound.
    """
    own = world.universe.learners[IMPROVED].iterations
    goal, rungs, found = world.tuned(IMPROVED, own).mean(axis=0), world.universe.rungs, {}
    rung = len(rungs) // 2
    while 0 <= rung < len(rungs) and rung not in found:
        found[rung] = world.tuned(RITTER, rungs[rung]).mean(axis=0)
        rung += -1 if (found[rung] <= goal).all() else 1
    tried = sorted(found)
    grid, errors = np.array([rungs[i] for i in tried]), np.array([found[i] for i in tried])
    needed = float(iterations_needed(grid, errors, goal))
    if np.isnan(needed):
        return {"factor": rungs[0] / own, "bound": -1}
    if np.isinf(needed):
        return {"factor": rungs[-1] / own, "bound": 1}
    return {"factor": needed / own, "bound": 0}
