"""The nominal controller: from a pose command to joint angles, by the kinematics of the intact robot.

It stands for the inverse kinematics that the manufacturer built in, which the paper leaves untouched (section 3): the same
command always gives the same joint angles. Newton's method starts from a polynomial that knows the workspace roughly, and
each command is solved by itself, so neither the commands before it nor those beside it in a batch have an influence.
"""

from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from recalib.errors import UnfitWorkspace, Unreachable
from recalib.monomials import monomials
from recalib.nominal.kinematics import Arm
from recalib.nominal.robots import Robot

KNOTS = 3  # along each coordinate: the box's two faces and its middle
BOXES = 0.25, 0.5, 0.75, 1.0  # on which they lie, as parts of the workspace
DEGREE = (
    3  # of the first guess: off by a degree or less, from where Newton's method needs three steps
)
TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
GREATEST_CONDITION = 60.0  # of a Jacobian in units of the workspace; a UR10 at work has 12
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch that it starts on


@dataclass(frozen=True)
class Solution:
    """Joint angles (n, 6) [rad], what is left of each command's residual (n,), and whether they are on the arm's limits."""

    angles: np.ndarray
    residuals: np.ndarray
    within_limits: np.ndarray

    @property
    def reached(self) -> np.ndarray:
        """(n,) whether the command can be executed."""
        return (self.residuals <= TOLERANCE) & self.within_limits


class Targets(NamedTuple):
    """Joint angles (run, move, 6) [rad] to which commands take the robots, and whether they are carried out (run, move)."""

    angles: np.ndarray
    executed: np.ndarray


class Controller:
    """The nominal inverse kinematics of a robot over its workspace.

    Args:
        robot: the nominal robot.
        greatest_condition: the singularity margin: the largest condition number of the Jacobian that is accepted on the
            knots, with pose velocities divided by the half-ranges of the workspace.

    Raises UnfitWorkspace where the workspace is out of reach, beyond a joint limit or too near to a singularity.
    """

    def __init__(self, robot: Robot, greatest_condition: float = GREATEST_CONDITION):
        self.robot = robot
        grid = np.array(list(product(np.linspace(-1, 1, KNOTS), repeat=6)))
        knots, solved = np.tile(robot.home, (len(grid), 1)), []
        for part in BOXES:  # from home outwards, so that every knot is on the branch of home
            poses = robot.workspace.to_poses(grid * part)
            knots, residuals = solve_newton(robot.arm, poses, knots)
            solved.append(knots)
        self._check_reach(poses, residuals)
        self._check_limits(knots)
        self._check_condition(knots, greatest_condition)
        features = monomials(np.concatenate([grid * part for part in BOXES]), DEGREE)
        self._guess = np.linalg.lstsq(features, np.concatenate(solved))[0]

    def solve(self, poses: np.ndarray) -> Solution:
        """Joint angles for the commanded poses (n, 4, 4), never raising: see `Solution.reached`."""
        inside = np.clip(
            self.robot.workspace.to_coordinates(poses), -1, 1
        )  # a polynomial knows nothing of what is beyond
        features = monomials(inside, DEGREE)
        start = (features[:, None] @ self._guess)[
            :, 0
        ]  # row by row: one product of all would round with the batch's size
        angles, residuals = solve_newton(self.robot.arm, poses, start)
        within = np.all((angles >= self.robot.lower) & (angles <= self.robot.upper), axis=-1)
        return Solution(angles, residuals, within)

    def targets(self, commands: np.ndarray) -> Targets:
        """What the commands, coordinates (run, move, 6), ask of the joints."""
        solution = self.solve(self.robot.workspace.to_poses(commands.reshape(-1, 6)))
        return Targets(
            solution.angles.reshape(commands.shape), solution.reached.reshape(commands.shape[:-1])
        )

    def inverse(self, poses: np.ndarray) -> np.ndarray:
        """Joint angles (n, 6) [rad] for the commanded poses (n, 4, 4).

        Raises Unreachable for the first command that cannot be executed.
        """
        solution = self.solve(poses)
        for index in np.flatnonzero(~solution.reached):
            reason = (
                "only beyond the joint limits"
                if solution.residuals[index] <= TOLERANCE
                else "no joint angles reach it"
            )
            raise Unreachable(poses[index], solution.residuals[index], reason)
        return solution.angles

    def _check_reach(self, poses: np.ndarray, residuals: np.ndarray) -> None:
        name, worst, missed = self.robot.name, residuals.argmax(), np.sum(residuals > TOLERANCE)
        if missed:
            raise UnfitWorkspace(
                f"the {name} cannot reach {missed} of the {len(poses)} poses on a grid over its workspace."
                f" {Unreachable(poses[worst], residuals[worst], 'no joint angles reach it')}."
                " Make its workspace smaller or move its home"
            )

    def _check_limits(self, knots: np.ndarray) -> None:
        robot = self.robot
        for knot, joint in np.argwhere((knots < robot.lower) | (knots > robot.upper)):
            turn, low, high = np.degrees(
                [knots[knot, joint], robot.lower[joint], robot.upper[joint]]
            )
            raise UnfitWorkspace(
                f"the {robot.name} would have to turn {robot.joints[joint]} to {turn:.1f} deg in its workspace, beyond its"
                f" limits of {low:.1f} to {high:.1f} deg. Make its workspace smaller or move its home"
            )

    def _check_condition(self, knots: np.ndarray, greatest: float) -> None:
        _, jacobians = self.robot.arm.forward_and_jacobian(knots)
        condition = np.linalg.cond(jacobians / self.robot.workspace.half_ranges[:, None]).max()
        if condition > greatest:
            raise UnfitWorkspace(
                f"the {self.robot.name} comes too near to a singularity in its workspace: its Jacobian's condition number"
                f" reaches {condition:.3g}; greatest_condition allows {greatest:.3g}"
            )


def solve_newton(arm: Arm, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles (n, 6) [rad] that take the arm's tool to the poses (n, 4, 4), from angles (n, 6) nearby.

    Returns the angles and what is left of each residual (n,), in m and rad: above TOLERANCE, the pose was not reached.
    """
    angles, residuals = start.copy(), np.full(len(poses), np.inf)
    unsolved = np.arange(len(poses))
    for _ in range(STEPS):
        reached, jacobians = arm.forward_and_jacobian(angles[unsolved])
        missing = twists(reached, poses[unsolved])
        residuals[unsolved] = np.abs(missing).max(axis=-1)
        left = residuals[unsolved] > TOLERANCE
        if not left.any():
            break
        unsolved = unsolved[left]
        steps = solve_each(jacobians[left], missing[left])
        steps *= np.minimum(1, LONGEST_STEP / np.abs(steps).max(axis=-1, keepdims=True))
        angles[unsolved] += steps
    return angles, residuals


def twists(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes the poses `start` (..., 4, 4) to `end`, (..., 6): translation [m] and turn along the base's axes.

    The turn is the axis times the sine of the angle [rad], which is the angle where Newton's method ends.
    """
    between = end[..., :3, :3] @ start[..., :3, :3].swapaxes(-2, -1)
    turns = (between - between.swapaxes(-2, -1))[..., [2, 0, 1], [1, 2, 0]] / 2
    return np.concatenate([end[..., :3, 3] - start[..., :3, 3], turns], axis=-1)


def solve_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The solutions (..., 6) of linear equations, (..., 6, 6) and (..., 6); of a singular one the smallest."""
    try:
        return np.linalg.solve(matrices, vectors[..., None])[..., 0]
    except np.linalg.LinAlgError:  # one of them is exactly singular
        return (np.linalg.pinv(matrices) @ vectors[..., None])[..., 0]
