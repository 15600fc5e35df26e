"""The influence of positions on orientation commands, and the reverse (section 4)."""

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.controller import Controller
from recalib.nominal.poses import ORIENTATION, POSITION
from replication.mapping.true_mapping import mapping_jacobians

BLOCKS = {"position": (POSITION, ORIENTATION), "orientation": (ORIENTATION, POSITION)}


def coupling(controller: Controller, arm: DamagedArm, desired: np.ndarray) -> pd.DataFrame:
    """Ratios of off-diagonal to diagonal blocks of the true mapping's Jacobian.

    Returns a row for each of the desired poses (n, 6), with columns position and orientation for
    the two commands: ratios of the blocks' Frobenius norms, in workspace coordinates.
    """
    jacobians = mapping_jacobians(controller, arm, desired)
    norm = {
        name: [np.linalg.norm(jacobians[:, row, column], axis=(1, 2)) for column in (row, other)]
        for name, (row, other) in BLOCKS.items()
    }
    return pd.DataFrame({name: off / diagonal for name, (diagonal, off) in norm.items()})
