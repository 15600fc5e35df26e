"""How much do positions influence orientation commands, and the reverse (section 4)?"""

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.controller import Controller
from recalib.nominal.poses import ORIENTATION, POSITION
from replication.mapping.true_mapping import mapping_jacobians

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
