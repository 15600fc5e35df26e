"""How much do positions influence orientation commands, and the reverse (section 4)?"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.controller import Controller
from recalib.nominal.poses import ORIENTATION, POSITION
from recalib.numerics.randomness import generator
from recalib.study.mapping.true_mapping import mapping_jacobians
from recalib.study.scenarios.plants import Resolved

BLOCKS = {"position": (POSITION, ORIENTATION), "orientation": (ORIENTATION, POSITION)}


def coupling(controller: Controller, arm: DamagedArm, desired: np.ndarray) -> pd.DataFrame:
    """The off-diagonal blocks of the true mapping's Jacobian against the diagonal ones.

    Returns a row for each of the desired poses (n, 6), with columns position and orientation for
    these commands: the ratio of the blocks' Frobenius norms, in coordinates of the workspace.
    """
    jacobians = mapping_jacobians(controller, arm, desired)
    norm = {
        name: [np.linalg.norm(jacobians[:, own, part], axis=(1, 2)) for part in (own, other)]
        for name, (own, other) in BLOCKS.items()
    }
    return pd.DataFrame({name: off / diagonal for name, (diagonal, off) in norm.items()})


def couplings(scenarios: Sequence[Path], poses: int, seed: int) -> pd.DataFrame:
    """The coupling at so many random poses of each scenario, from their files as resolved."""
    tables = []
    for scenario in map(Resolved.read, scenarios):
        controller = scenario.controller()
        random = generator(seed, "study", "coupling")
        desired = controller.robot.workspace.sample(random, poses)
        table = coupling(controller, scenario.arm(controller.robot), desired)
        tables.append(table.assign(scenario=scenario.scenario))
    return pd.concat(tables)
