"""The nominal controller: joint angles for a pose command, from the kinematics of the intact robot.

It represents the manufacturer's inverse kinematics, which the paper leaves untouched (section 3):
the same command always gives the same joint angles. Newton's method starts from a polynomial that
approximates the joint angles over the workspace. Each command is solved independently: no other
command, before it or in the same batch, affects the result.

The same holds for a redundant arm, with more than six joints. Among the postures for a pose, the
controller chooses one near home that changes smoothly with the pose: the polynomial fits postures
that were found from home outwards by shortest steps, and Newton's method continues from there by
shortest steps. So a pose determines the joint angles, and a learner needs no more than poses.
"""

from functools import cached_property
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from recalib.arrays import array_of, ending
from recalib.errors import UnfitWorkspace, Unreachable, check_kind
from recalib.nominal import kernels
from recalib.nominal.chain import TOLERANCE, Chain
from recalib.nominal.robots import Robot, shown
from recalib.numerics.monomials import factors, monomials

KNOTS = 3  # along each coordinate: the box's two faces and its middle
BOXES = 0.25, 0.5, 0.75, 1.0  # sizes of the boxes with knots, relative to the workspace
DEGREE = 3  # of the start polynomial: its error is at most a degree, so three Newton steps suffice
NOT_REACHED = "no joint angles reach it"
GREATEST_CONDITION = 60.0  # of a Jacobian in units of the workspace; a UR10 typically has 12


class Targets(NamedTuple):
    """Joint angles for commands.

    Attributes:
        angles: (..., joint) rad, the solutions.
        residuals: (...) the largest component of the remaining pose error, in m or rad.
        within_limits: (...) whether the angles are within the joint limits.
    """

    angles: np.ndarray
    residuals: np.ndarray
    within_limits: np.ndarray

    @property
    def executed(self) -> np.ndarray:
        """(...) whether each command is executed."""
        return (self.residuals <= TOLERANCE) & self.within_limits


class Controller:
    """The nominal inverse kinematics of a robot over its workspace.

    Args:
        robot: the nominal robot.
        greatest_condition: the singularity margin: the largest accepted condition number of the
            Jacobian on a grid over the workspace, with pose velocities divided by the workspace's
            half-ranges.

    Raises UnfitWorkspace if part of the workspace is out of reach, beyond a joint limit or too near
    to a singularity, and InvalidSetting if `robot` is not a Robot.
    """

    def __init__(self, robot: Robot, greatest_condition: float = GREATEST_CONDITION):
        check_kind("robot", robot, Robot)
        check_kind("greatest_condition", greatest_condition, float, int)
        self.robot, self._chain = robot, Chain.of(robot.arm)
        grid = np.array(list(product(np.linspace(-1, 1, KNOTS), repeat=6)))
        knots, solved = np.tile(robot.home, (len(grid), 1)), []
        for part in BOXES:  # from home outwards: all knots are on the same branch of solutions
            poses = robot.workspace.to_poses(grid * part)
            knots, residuals = self._chain.solve(poses, knots)
            solved.append(knots)
        self._check_reach(poses, residuals)
        self._check_limits(knots)
        self._check_condition(knots, greatest_condition)
        self._knots = np.concatenate([grid * part for part in BOXES]), np.concatenate(solved)

    @cached_property
    def nominal(self) -> kernels.ControllerArrays:
        """The arrays for compiled loops: the arm, its workspace, limits and start polynomial.

        The polynomial is fitted to the knots when it is first needed.
        """
        coordinates, angles = self._knots
        q, r = np.linalg.qr(monomials(coordinates, DEGREE))
        start = *factors(6, DEGREE), np.linalg.solve(r, q.T @ angles)
        limits = self.robot.lower, self.robot.upper
        arguments: tuple[Any, ...] = *self._chain, *self.robot.workspace.region, *start, *limits
        return kernels.ControllerArrays(*arguments)

    def solve(self, poses: np.ndarray) -> Targets:
        """Joint targets for the commanded poses (..., 4, 4), also for unreachable ones.

        Raises InvalidSetting for another shape.
        """
        return self.targets(self.robot.workspace.to_coordinates(poses))

    def targets(self, commands: np.ndarray) -> Targets:
        """Joint targets for commands, coordinates (..., 6), also for unreachable ones.

        Raises InvalidSetting for another shape.
        """
        commands = ending("commands", commands, 6)
        found = kernels.targets(*self.nominal, commands.reshape(-1, 6))
        axes = commands.shape[:-1]
        return Targets(*(part.reshape((*axes, *part.shape[1:])) for part in found))

    def inverse(self, poses: np.ndarray) -> np.ndarray:
        """Joint angles (n, joint) [rad] for the commanded poses (n, 4, 4).

        Raises Unreachable for the first command that cannot be executed, and InvalidSetting for
        another shape.
        """
        solution = self.solve(poses := array_of("poses", poses, ("n", 4, 4)))
        for index in np.flatnonzero(~solution.executed):
            reached = solution.residuals[index] <= TOLERANCE
            reason = "only beyond the joint limits" if reached else NOT_REACHED
            raise Unreachable(poses[index], solution.residuals[index], reason)
        return solution.angles

    def _check_reach(self, poses: np.ndarray, residuals: np.ndarray) -> None:
        beyond, worst = np.sum(residuals > TOLERANCE), residuals.argmax()
        if beyond:
            example = Unreachable(poses[worst], residuals[worst], NOT_REACHED)
            raise UnfitWorkspace(
                f"the {self.robot.name} cannot reach {beyond} of the {len(poses)} poses on a grid"
                f" over its workspace. {example}. Make its workspace smaller or move its home"
            )

    def _check_limits(self, knots: np.ndarray) -> None:
        robot = self.robot
        for knot, joint in np.argwhere((knots < robot.lower) | (knots > robot.upper)):
            coordinate, low, high = (
                shown(bound, robot.arm.slides[joint])
                for bound in (knots[knot, joint], robot.lower[joint], robot.upper[joint])
            )
            raise UnfitWorkspace(
                f"the {robot.name} would have to move {robot.joints[joint]} to {coordinate} in"
                f" its workspace, beyond its limits of {low} to {high}."
                " Make its workspace smaller or move its home"
            )

    def _check_condition(self, knots: np.ndarray, greatest: float) -> None:
        _, jacobians = self.robot.arm.forward_and_jacobian(knots)
        condition = np.linalg.cond(jacobians / self.robot.workspace.half_ranges[:, None]).max()
        if not condition <= greatest:  # also of a NaN
            raise UnfitWorkspace(
                f"the {self.robot.name} comes too near to a singularity in its workspace: its"
                f" Jacobian's condition number reaches {condition:.3g}; greatest_condition allows"
                f" {greatest:.3g}"
            )
