"""The numbers of joint angles and of commands that reach a pose (section 3)."""

import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm
from recalib.nominal.chain import TOLERANCE
from recalib.nominal.controller import Controller

STARTS = 50  # of Newton's method for each pose, anywhere in joint space
SAME = 1e-6  # rad: smaller differences of joint angles are ignored


def joint_solutions(
    arm: DamagedArm, pose: np.ndarray, starts: np.ndarray, within: tuple[np.ndarray, np.ndarray]
) -> np.ndarray:
    """All joint angles (n, joint) [rad] found for a pose (4, 4) [m] from starts (start, joint).

    These are encoder angles; solutions that differ by full turns count once.

    Args:
        within: lower and upper joint limits, each (joint,).
    """
    angles, residuals = arm.chain.solve(np.tile(pose, (len(starts), 1, 1)), starts)
    candidates = angles[residuals <= TOLERANCE]
    candidates = candidates[np.all((candidates >= within[0]) & (candidates <= within[1]), axis=1)]
    different: list[np.ndarray] = []
    for candidate in candidates:
        if not any(are_same(candidate, other) for other in different):
            different.append(candidate)
    return np.array(different).reshape(-1, starts.shape[1])


def are_same(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Whether joint angles (..., joint) [rad] are the same except for full turns."""
    return np.abs(np.sin((first - second) / 2)).max(axis=-1) <= SAME / 2


def solutions(
    controller: Controller, arm: DamagedArm, desired: np.ndarray, random: np.random.Generator
) -> pd.DataFrame:
    """The numbers of joint angles and of commands that reach each of the desired poses (n, 6).

    A command reaches a pose if the controller chooses joint angles that reach it. The damaged arm
    must not be redundant, nor have deflections.
    """
    robot = controller.robot
    workspace, rows = robot.workspace, []
    poses = workspace.to_poses(desired)
    for pose, nominal in zip(poses, controller.solve(poses).angles, strict=True):
        anywhere = random.uniform(-np.pi, np.pi, (STARTS, len(nominal)))
        starts = np.vstack([nominal, anywhere])
        angles = joint_solutions(arm, pose, starts, (robot.lower, robot.upper))
        commands = workspace.to_coordinates(robot.arm.forward(angles))
        answers = controller.targets(commands[None])
        reach = answers.executed[0] & are_same(answers.angles[0], angles)
        rows.append({"joint_solutions": len(angles), "commands": int(reach.sum())})
    return pd.DataFrame(rows)
