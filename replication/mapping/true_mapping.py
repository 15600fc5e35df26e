"""The true mapping, which learners approximate: from desired poses to commands that reach them."""

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.chain import TOLERANCE, Chain
from recalib.nominal.controller import Controller
from recalib.nominal.workspace import ORIENTATION, POSITION

BLOCKS = {"position": (POSITION, ORIENTATION), "orientation": (ORIENTATION, POSITION)}
STEP = 1e-4  # step of the central differences, in workspace coordinates: 25 um


def true_commands(controller: Controller, arm: DamagedArm, desired: np.ndarray) -> np.ndarray:
    """The commands (n, 6) that take a damaged arm to the desired poses (n, 6), or NaN if none does.

    The arm must have no deflections and not be redundant, so that a pose determines joint angles.
    """
    workspace = controller.robot.workspace
    poses = workspace.to_poses(desired)
    angles, residuals = arm.chain.solve(poses, controller.solve(poses).angles)
    commands = workspace.to_coordinates(Chain.of(controller.robot.arm).forward(angles[None])[0])
    commands[residuals > TOLERANCE] = np.nan
    return commands


def mapping_jacobians(controller: Controller, arm: DamagedArm, desired: np.ndarray) -> np.ndarray:
    """Jacobians (n, 6, 6), d command / d desired pose, at the desired poses (n, 6)."""
    ahead, behind = (
        true_commands(
            controller, arm, (desired[:, None] + sign * STEP * np.eye(6)).reshape(-1, 6)
        ).reshape(-1, 6, 6)
        for sign in (1, -1)
    )
    return (ahead - behind).swapaxes(1, 2) / (2 * STEP)


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
