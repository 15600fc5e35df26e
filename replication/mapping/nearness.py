"""Is coupling weak because the workspace is small and far from singularities (section 4)?"""

import numpy as np
import pandas as pd

from recalib.nominal.workspace import POSITION
from recalib.numerics.randomness import generator
from replication.mapping.true_mapping import coupling
from replication.scenarios.plants import Resolved

# Relative sizes of the workspace along each position axis. At twice the size a UR10 still reaches
# most poses, and the condition numbers of some are ten times as large.
SIZES = 1, 2
DRAWS = 10


def nearness(resolved: Resolved, poses: int, seed: int) -> pd.DataFrame:
    """The coupling in the workspace and in a larger one, with condition numbers of Jacobians.

    Args:
        poses: number of random poses in each draw and size.

    Returns a row for each reachable pose, with columns size, draw and condition, the condition
    number of the nominal Jacobian, and the columns of `coupling`. The units are half-ranges of the
    original workspace for all sizes.
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
