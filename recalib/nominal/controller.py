"""The nominal controller: joint angles for a pose command, by the kinematics of the intact robot.

It stands for the inverse kinematics that the manufacturer built in, which the paper leaves
untouched (section 3): the same command always gives the same joint angles. Newton's method starts
from a polynomial that approximates the joint angles over the workspace. Each command is solved by
itself: no other command, before it or in the same batch, has an influence.

The same holds for a redundant arm, with more than six joints. Of the postures for a pose the
controller takes one near home, which changes smoothly with the pose: the polynomial fits postures
that were found from home outwards by the shortest steps, and from there Newton's method takes the
shortest ones, too. So poses determine joint angles, and a learner that sees poses alone misses
nothing.
"""

from collections.abc import Callable
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
BOXES = 0.25, 0.5, 0.75, 1.0  # on which they lie, as parts of the workspace
DEGREE = 3  # of the first guess: off by a degree or less, where Newton's method needs three steps
NOT_REACHED = "no joint angles reach it"
ROUNDS = 4  # in which the joint angles of a redundant arm settle; each leaves some hundredths
GREATEST_CONDITION = 60.0  # of a Jacobian in units of the workspace; a UR10 at work has 12


class Targets(NamedTuple):
    """Joint angles for commands.

    Attributes:
        angles: (..., joint) rad to which they take the robots.
        residuals: (...) the largest remaining component of the pose, in m or rad.
        within_limits: (...) whether the arm's joints can turn so far.
    """

    angles: np.ndarray
    residuals: np.ndarray
    within_limits: np.ndarray

    @property
    def executed(self) -> np.ndarray:
        """(...) whether they are carried out."""
        return (self.residuals <= TOLERANCE) & self.within_limits


class Controller:
    """The nominal inverse kinematics of a robot over its workspace.

    Args:
        robot: the nominal robot.
        greatest_condition: the singularity margin: the largest condition number of the Jacobian
            that is accepted on a grid over the workspace, with pose velocities divided by the
            workspace's half-ranges.

    Raises UnfitWorkspace where the workspace is out of reach, beyond a joint limit or too near to a
    singularity, and InvalidSetting: something else than a robot.
    """

    def __init__(self, robot: Robot, greatest_condition: float = GREATEST_CONDITION):
        check_kind("robot", robot, Robot)
        check_kind("greatest_condition", greatest_condition, float, int)
        self.robot, self._chain = robot, Chain.of(robot.arm)
        grid = np.array(list(product(np.linspace(-1, 1, KNOTS), repeat=6)))
        knots, solved = np.tile(robot.home, (len(grid), 1)), []
        for part in BOXES:  # from home outwards, so that every knot is on the branch of home
            poses = robot.workspace.to_poses(grid * part)
            knots, residuals = self._chain.solve(poses, knots)
            solved.append(knots)
        self._check_reach(poses, residuals)
        self._check_limits(knots)
        self._check_condition(knots, greatest_condition)
        self._knots = np.concatenate([grid * part for part in BOXES]), np.concatenate(solved)

    @cached_property
    def nominal(self) -> kernels.ControllerArrays:
        """What compiled loops need to answer commands: the arm, its workspace, where they start.

        The start is a polynomial through the knots, which is made when it is first needed.
        """
        coordinates, angles = self._knots
        q, r = np.linalg.qr(monomials(coordinates, DEGREE))
        start = *factors(6, DEGREE), np.linalg.solve(r, q.T @ angles)
        limits = self.robot.lower, self.robot.upper
        given: tuple[Any, ...] = *self._chain, *self.robot.workspace.region, *start, *limits
        return kernels.ControllerArrays(*given)

    def solve(self, poses: np.ndarray) -> Targets:
        """Joint targets of the commanded poses (..., 4, 4). Raises as `targets`."""
        return self.targets(self.robot.workspace.to_coordinates(poses))

    def targets(self, commands: np.ndarray) -> Targets:
        """Joint targets of the commands, coordinates (..., 6).

        Raises nothing but InvalidSetting, of another shape.
        """
        commands = ending("commands", commands, 6)
        found = kernels.targets(*self.nominal, commands.reshape(-1, 6))
        axes = commands.shape[:-1]
        return Targets(*(part.reshape((*axes, *part.shape[1:])) for part in found))

    def commands_for(
        self, commands: np.ndarray, needed: Callable[[np.ndarray], np.ndarray]
    ) -> np.ndarray:
        """The commands (run, move, 6) that yield the required joint angles.

        Of a redundant arm there are many; those are meant which are found from its own answer.

        Args:
            commands: (run, move, 6) nearby.
            needed: from joint angles (run, move, joint) [rad] to those nearby that are needed.
        """
        workspace, arm = self.robot.workspace, self.robot.arm
        for _ in range(ROUNDS if len(arm.joints) > 6 else 1):
            angles = needed(self.targets(commands).angles)
            poses = arm.forward(angles.reshape(-1, angles.shape[-1]))
            commands = workspace.to_coordinates(poses).reshape(commands.shape)
        return commands

    def inverse(self, poses: np.ndarray) -> np.ndarray:
        """Joint angles (n, joint) [rad] for the commanded poses (n, 4, 4).

        Raises Unreachable for the first command that cannot be executed, and InvalidSetting:
        another shape.
        """
        solution = self.solve(poses := array_of("poses", poses, ("n", 4, 4)))
        for index in np.flatnonzero(~solution.executed):
            there = solution.residuals[index] <= TOLERANCE
            reason = "only beyond the joint limits" if there else NOT_REACHED
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
