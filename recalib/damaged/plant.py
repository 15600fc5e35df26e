"""Simulated damaged robots: they take a pose command and return the achieved pose."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from recalib.arrays import ending
from recalib.damaged.damage import DamagedArm
from recalib.damaged.disturbances import Disturbances
from recalib.errors import InvalidSetting, check_kind
from recalib.loop.interfaces import ForwardKinematics, Outcome
from recalib.nominal import kernels
from recalib.nominal.chain import Chain
from recalib.nominal.controller import Controller, Targets
from recalib.nominal.workspace import Workspace
from recalib.spelling import listed


class Plant:
    """Damaged robots behind one nominal controller, one robot for each run of an experiment.

    Args:
        controller: the nominal controller, which does not know the damage.
        arms: a damaged arm for each run, or a single one for all runs, which may be any
            `ForwardKinematics`, such as the twin of a real arm.
        disturbances: random errors of moves and measurements; default: none.
        generators: a random generator for each run, for the disturbances.

    Attributes:
        moves: the number of moves commanded in each run.

    Raises InvalidSetting for arguments of other types; its methods raise it for commands of another
    shape or another number of runs.
    """

    def __init__(
        self,
        controller: Controller,
        arms: ForwardKinematics | Sequence[DamagedArm],
        disturbances: Disturbances | None = None,
        generators: Sequence[np.random.Generator] = (),
    ):
        check_kind("controller", controller, Controller)
        check_kind("arms", arms, ForwardKinematics, Sequence)
        check_kind("disturbances", disturbances, Disturbances, type(None))
        self._controller = controller
        self._disturbances, self._generators = disturbances, generators
        self._arms = [arms] if isinstance(arms, ForwardKinematics) else [*arms]
        if not self._arms:
            raise InvalidSetting("arms", "none", "at least one")
        for arm in self._arms:
            check_kind("arm", arm, ForwardKinematics)
        check_kind("generators", generators, Sequence)
        for one in generators:
            check_kind("generator", one, np.random.Generator)
        if disturbances is not None and not generators:
            raise InvalidSetting("generators", "none", "one for each disturbed run")
        rigid = (arm for arm in self._arms if isinstance(arm, DamagedArm) and not arm.deflections)
        chains = [arm.chain for arm in rigid]
        # side by side; None unless geometry alone determines the poses of all arms
        self._chain = Chain.side_by_side(chains) if len(chains) == len(self._arms) else None
        self._home = self._forward(np.tile(controller.robot.home, (len(self._arms), 1, 1)))
        self._home_coordinates = self.workspace.to_coordinates(self._home[:, 0])
        self.moves = 0
        self._refused = np.zeros(0, dtype=int)

    @property
    def refused(self) -> np.ndarray | int:
        """The number (run,) of moves that the controller refused; 0 before the first move."""
        return self._refused.copy() if self.moves else 0

    @property
    def workspace(self) -> Workspace:
        """The workspace in whose coordinates commands and achieved poses are given."""
        return self._controller.robot.workspace

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and measure what the robots achieve."""
        runs = [len(self._refused)] if self.moves else []
        runs += [] if self._disturbances is None else [len(self._generators)]
        commands = self._checked(commands, *runs)
        if self.moves == 0:
            self._refused = np.zeros(len(commands), dtype=int)
        self.moves += commands.shape[1]
        if self._disturbances is None and self._chain is not None:
            moves = self._home_coordinates, np.ascontiguousarray(commands), self._refused
            arguments: tuple[Any, ...] = *self._controller.nominal, *self._chain, *moves
            return Outcome(*kernels.move(*arguments))
        targets, disturbances = self._controller.targets(commands), self._disturbances
        if disturbances is not None:
            stops = disturbances.of_joints(self._generators, targets.angles.shape[1:])
            stops[..., self._controller.robot.arm.slides] = 0  # repeatability is an angle
            targets = targets._replace(angles=targets.angles + stops)
        poses, executed = self.achieve_targets(targets)
        if disturbances is not None:
            poses = disturbances.measure(self._generators, poses)
        self._refused += np.sum(~executed, axis=1)
        return Outcome(self.workspace.to_coordinates(poses), executed)

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Achieved poses (run, move, 4, 4) and whether each was executed (run, move).

        These moves have no random errors and are not counted.
        """
        return self.achieve_targets(self._controller.targets(self._checked(commands)))

    def _checked(self, commands: np.ndarray, *runs: int) -> np.ndarray:
        """Commands (run, move, 6) of as many runs as before, and as there are arms if several."""
        array = ending("commands", commands, 6)
        counts = {*runs, *([len(self._arms)] if len(self._arms) > 1 else [])}
        if array.ndim != 3 or counts - {len(array)}:
            valid = f"an array ({listed(map(str, counts or ['runs']), 'and')}, moves, 6)"
            raise InvalidSetting("commands", f"of shape {array.shape}", valid)
        return array

    def achieve_targets(self, targets: Targets) -> tuple[np.ndarray, np.ndarray]:
        """Like `achieve`, for joint angles instead of pose commands."""
        poses, executed = self._forward(targets.angles), targets.executed
        if not executed.all():
            homes = np.broadcast_to(self._home, poses.shape)
            poses[~executed] = homes[~executed]
        return poses, executed

    def _forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (run, move, 4, 4) [m] at the joint angles (run, move, joint) [rad]."""
        if self._chain is not None:
            return kernels.forward(tuple(self._chain), angles)
        if len(self._arms) > 1:
            pairs = zip(self._arms, angles, strict=True)
            return np.stack([arm.forward(joints) for arm, joints in pairs])
        poses = self._arms[0].forward(angles.reshape(-1, angles.shape[-1]))
        return poses.reshape(*angles.shape[:-1], 4, 4)
