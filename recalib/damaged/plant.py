"""Damaged robots as a learner meets them: a pose command goes in, the achieved pose comes out."""

from collections.abc import Callable, Sequence

import numpy as np

from recalib.damaged.damage import DamagedArm
from recalib.damaged.disturbances import Disturbances
from recalib.loop.interfaces import ForwardKinematics, Outcome
from recalib.nominal.chain import Chain
from recalib.nominal.controller import Controller, Targets
from recalib.nominal.poses import Workspace


class Plant:
    """Damaged robots behind one nominal controller, one robot for each run of an experiment.

    Args:
        controller: the nominal controller, which knows of no damage.
        arms: a damaged one for each run, or a single one for all runs, which may be anything that
            moves, such as the twin of a real one.
        disturbances: of the executed moves; none unless given.
        generators: their randomness, one for each run.

    Attributes:
        moves: how many moves were commanded in each run.
        refused: (run,) how many of them the controller refused; 0 before the first.
    """

    def __init__(
        self,
        controller: Controller,
        arms: ForwardKinematics | Sequence[DamagedArm],
        disturbances: Disturbances | None = None,
        generators: Sequence[np.random.Generator] = (),
    ):
        self._controller = controller
        self._disturbances, self._generators = disturbances, generators
        self._forward = _forward(arms)
        different = 1 if isinstance(arms, ForwardKinematics) else len(arms)
        self._home = self._forward(np.tile(controller.robot.home, (different, 1, 1)))
        self.moves = 0
        self.refused: np.ndarray | int = 0

    @property
    def workspace(self) -> Workspace:
        """The workspace in whose coordinates commands and achieved poses are given."""
        return self._controller.robot.workspace

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and measure what the robots achieve."""
        targets = self._controller.targets(commands)
        if self._disturbances is None:
            poses, executed = self.achieve_targets(targets)
        else:
            stops = self._disturbances.of_joints(self._generators, targets.angles.shape[1:])
            stops[..., self._controller.robot.arm.slides] = 0  # an angle is no length
            poses, executed = self.achieve_targets(targets._replace(angles=targets.angles + stops))
            poses = self._disturbances.measure(self._generators, poses)
        self.moves += executed.shape[1]
        self.refused = self.refused + np.sum(~executed, axis=1)
        return Outcome(self.workspace.to_coordinates(poses), executed)

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Achieved poses (run, move, 4, 4) and whether each was executed (run, move).

        Undisturbed and not counted.
        """
        return self.achieve_targets(self._controller.targets(commands))

    def achieve_targets(self, targets: Targets) -> tuple[np.ndarray, np.ndarray]:
        """As `achieve`, for commands that the controller has turned into joint angles."""
        angles, executed = targets
        poses = self._forward(angles)
        if not executed.all():
            homes = np.broadcast_to(self._home, poses.shape)
            poses[~executed] = homes[~executed]
        return poses, executed


def _forward(
    arms: ForwardKinematics | Sequence[DamagedArm],
) -> Callable[[np.ndarray], np.ndarray]:
    """From joint angles (run, move, joint) [rad] to poses (run, move, 4, 4) [m]."""
    if isinstance(arms, ForwardKinematics):
        return lambda angles: arms.forward(angles.reshape(-1, angles.shape[-1])).reshape(
            *angles.shape[:-1], 4, 4
        )
    chain = Chain.side_by_side([arm.chain for arm in arms])
    return lambda angles: chain.forward(
        np.stack([arm.standing(own) for arm, own in zip(arms, angles, strict=True)])
    )
