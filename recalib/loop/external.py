"""A user's own robot in place of the simulated ones."""

from collections.abc import Callable

import numpy as np

from recalib.loop.interfaces import Outcome
from recalib.loop.measurements import checked_pose
from recalib.nominal.poses import Workspace


class ExternalRobot:
    """A robot of your own, real or simulated, for learners to command; see `Commandable`.

    It serves any number of runs, one move after the other.

    Args:
        workspace: in which it works.
        move: commands a pose (4, 4) in the base frame [m] and returns the measured pose (4, 4), or
            None if the robot refuses.

    Attributes:
        moves: how many moves were commanded in each run.
        refused: (run,) how many of them the robot refused; 0 before the first.
    """

    def __init__(self, workspace: Workspace, move: Callable[[np.ndarray], np.ndarray | None]):
        self.workspace, self._move = workspace, move
        self.moves = 0
        self.refused: np.ndarray | int = 0

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and take what the robot measures.

        Raises BadMeasurement, as `achieve`.
        """
        poses, executed = self.achieve(commands)
        self.moves += executed.shape[1]
        self.refused = self.refused + np.sum(~executed, axis=1)
        return Outcome(self.workspace.to_coordinates(poses), executed)

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Measured poses (run, move, 4, 4) and whether each was executed (run, move), not counted.

        A refused move counts as the centre of the workspace. Raises BadMeasurement if a measurement
        is not a pose, or is grossly off.
        """
        poses = self.workspace.to_poses(commands)
        executed = np.ones(commands.shape[:-1], dtype=bool)
        for index in np.ndindex(executed.shape):
            measured = self._move(poses[index])
            executed[index] = measured is not None
            if measured is None:
                measured = self.workspace.centre
            else:
                measured = checked_pose(measured, self.workspace.centre)
            poses[index] = measured
        return poses, executed
