"""The true mapping, which learners approximate: from desired poses to commands that reach them."""

import numpy as np

from recalib.damaged.damage import DamagedArm
from recalib.nominal.chain import TOLERANCE, Chain
from recalib.nominal.controller import Controller

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
