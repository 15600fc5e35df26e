"""Is the coupling weak since the workspace is small and far from singularities (section 4)?"""

import numpy as np
import pandas as pd

from recalib.nominal.poses import POSITION
from recalib.numerics.randomness import generator
from replication.mapping.coupling import coupling
from replication.scenarios.plants import Resolved

# Of the workspace, along each axis of positions. In a box twice as long a UR10 reaches most poses,
# some of them ten times as near to a singularity, by their condition numbers.
SIZES = 1, 2
DRAWS = 10


def nearness(resolved: Resolved, poses: int, seed: int) -> pd.DataFrame:
    """The coupling in the workspace and in a larger one, with the distance from singularities.

    Args:
        poses: random ones in each draw and size.

    Returns a row for each pose that is reached, with columns size, draw and condition, the
    condition number of the nominal Jacobian, and those of `coupling`. All are in half-ranges of the
    workspace itself: a larger one changes where poses are, and no unit.
    """
    controller, tables = resolved.controller(), []
    robot, workspace = controller.robot, controller.robot.workspace
    arm = resolved.arm(robot)
    for size in SIZES:
        for draw in range(DRAWS):
            desired = workspace.sample(generator(seed, "study", "nearness", draw), poses)
            desired[:, POSITION] *= size
            solution = controller.solve(workspace.to_poses(desired))
            desired, angles = desired[solution.executed], solution.angles[solution.executed]
            _, jacobians = robot.arm.forward_and_jacobian(angles)
            condition = np.linalg.cond(jacobians / workspace.half_ranges[:, None])
            table = coupling(controller, arm, desired)
            tables.append(table.assign(size=size, draw=draw, condition=condition))
    return pd.concat(tables).dropna()
