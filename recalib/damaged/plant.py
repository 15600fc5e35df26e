"""Damaged robots as a learner meets them: a pose command goes in, the achieved pose comes out."""

from collections.abc import Sequence

import numpy as np

from recalib.damaged.damage import DamagedArm
from recalib.damaged.disturbances import Disturbances
from recalib.interfaces import ForwardKinematics, Outcome
from recalib.nominal.chain import Chain
from recalib.nominal.controller import Controller, Targets


class Plant:
    """Damaged robots behind one nominal controller, one robot for each run of an experiment.

    Args:
        controller: the nominal controller, which knows of no damage.
        arms: a damaged one for each run, or a single one for all runs, which may be the twin of a
            real one.
        disturbances: of the executed moves; none unless given.
        generators: their randomness, one for each run.

    Attributes:
        moves: how many moves were commanded in each run.
        refused: (run,) how many of them the controller refused; 0 before the first.
    """

    def __init__(
        self,
        controller: Controller,
        arms: Sequence[DamagedArm] | Sequence[ForwardKinematics],
        disturbances: Disturbances | None = None,
        generators: Sequence[np.random.Generator] = (),
    ):
        self._controller, self._arms = controller, arms
        self._disturbances, self._generators = disturbances, generators
        alone = len(arms) == 1
        self._together = None if alone else Chain.side_by_side([arm.chain for arm in arms])
        self._home = [arm.forward(controller.robot.home[None])[0] for arm in arms]
        self.moves = self.refused = 0

    @property
    def workspace(self):
        """The workspace in whose coordinates commands and achieved poses are given."""
        return self._controller.robot.workspace

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and measure what the robots achieve."""
        return self.execute_targets(self._controller.targets(commands))

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Achieved poses (run, move, 4, 4) and whether each was executed (run, move).

        Undisturbed and not counted.
        """
        return self.achieve_targets(self._controller.targets(commands))

    def execute_targets(self, targets: Targets) -> Outcome:
        """As `execute`, for commands that the controller has turned into joint angles."""
        if self._disturbances is None:
            poses, executed = self.achieve_targets(targets)
        else:
            stops = self._disturbances.of_joints(self._generators, targets.angles.shape[1:])
            poses, executed = self.achieve_targets(targets._replace(angles=targets.angles + stops))
            poses = self._disturbances.measure(self._generators, poses)
        self.moves += executed.shape[1]
        self.refused = self.refused + np.sum(~executed, axis=1)
        return Outcome(self.workspace.to_coordinates(poses), executed)

    def achieve_targets(self, targets: Targets) -> tuple[np.ndarray, np.ndarray]:
        """As `achieve`, for commands that the controller has turned into joint angles."""
        angles, executed = targets
        runs, moves, _ = angles.shape
        if self._together is None:
            poses = (
                self._arms[0].forward(angles.reshape(runs * moves, -1)).reshape(runs, moves, 4, 4)
            )
        else:
            standing = [arm.standing(own) for arm, own in zip(self._arms, angles, strict=True)]
            poses = self._together.forward(np.stack(standing))
        if not executed.all():
            homes = np.broadcast_to(np.stack(self._home)[:, None], poses.shape)
            poses[~executed] = homes[~executed]
        return poses, executed
