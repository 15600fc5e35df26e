"""How much do positions influence orientation commands, and the reverse (section 4)?"""

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.controller import Controller
from recalib.nominal.poses import ORIENTATION, POSITION
from recalib.study.mapping.true_mapping import mapping_jacobians

BLOCKS = {"position": (POSITION, ORIENTATION), "orientation": (ORIENTATION, POSITION)}


def coupling(controller: Controller, arm: DamagedArm, desired: np.ndarray) -> pd.DataFrame:
    """For position and orientation commands, the off-diagonal block of the true mapping's Jacobian against the diagonal one.

    Args:
        desired: (n, 6) poses where to look.

    Returns a row for each of them with columns position and orientation: the ratio of the blocks' Frobenius norms, in
    coordinates of the workspace.
    """
    jacobians = mapping_jacobians(controller, arm, desired)
    norm = {
        name: [np.linalg.norm(jacobians[:, own, seen], axis=(1, 2)) for seen in (own, other)]
        for name, (own, other) in BLOCKS.items()
    }
    return pd.DataFrame({name: off / diagonal for name, (diagonal, off) in norm.items()})
