"""A user's own robot in place of a simulated one, and checks of the poses that it measures."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from recalib.arrays import are_poses, array_of
from recalib.errors import BadMeasurement, check_function, check_kind
from recalib.loop.interfaces import Outcome
from recalib.nominal.workspace import Workspace

FARTHEST = 10.0  # m from the workspace's centre: farther poses are not in metres
SKEW = 0.01  # greatest error of R R' = 1: instruments round the numbers of a rotation matrix
POSE = "a rotation and a position, above a row of 0, 0, 0, 1"


class ExternalRobot:
    """Your own robot, real or simulated, for learners to command; see `Commandable`.

    It serves any number of runs and executes one move at a time.

    Args:
        workspace: the robot's workspace.
        move: commands a pose (4, 4) in the base frame [m] and returns the measured pose (4, 4), or
            None if the robot refuses.

    Attributes:
        moves: the number of moves commanded in each run.
        refused: (run,) the number of moves that the robot refused; 0 before the first move.

    Raises InvalidSetting for arguments of other types.
    """

    def __init__(self, workspace: Workspace, move: Callable[[np.ndarray], np.ndarray | None]):
        check_kind("workspace", workspace, Workspace)
        check_function("move", move)
        self.workspace, self._move = workspace, move
        self.moves = 0
        self.refused: np.ndarray | int = 0

    def execute(self, commands: np.ndarray) -> Outcome:
        """Command poses, coordinates (run, move, 6), and return the measured outcome.

        Raises BadMeasurement like `achieve`.
        """
        poses, executed = self.achieve(commands)
        self.moves += executed.shape[1]
        self.refused = self.refused + np.sum(~executed, axis=1)
        return Outcome(self.workspace.to_coordinates(poses), executed)

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Measured poses (run, move, 4, 4) and whether each was executed (run, move).

        These moves are not counted. The pose of a refused move is the centre of the workspace.
        Raises BadMeasurement if a measurement is not a pose, or is grossly off, and InvalidSetting
        if commands are not finite numbers.
        """
        poses = self.workspace.to_poses(array_of("commands", commands, ("n", "n", 6)))
        executed = np.ones(poses.shape[:-2], dtype=bool)
        for index in np.ndindex(executed.shape):
            measured = self._move(poses[index])
            executed[index] = measured is not None
            poses[index] = self.workspace.centre if measured is None else self._checked(measured)
        return poses, executed

    def _checked(self, given: ArrayLike) -> np.ndarray:
        """A measured pose (4, 4) [m]. Raises BadMeasurement if it is no pose, or grossly off."""
        try:
            measured = np.asarray(given, dtype=float)
        except (TypeError, ValueError):  # not numbers
            measured = np.empty(0)
        if measured.shape != (4, 4):
            valid = "a matrix (4, 4)"
        elif not np.isfinite(measured).all():
            valid = "numbers"
        elif not are_poses(measured, SKEW):
            valid = POSE
        elif np.linalg.norm((measured - self.workspace.centre)[:3, 3]) > FARTHEST:
            valid = f"m in the base frame, at most {FARTHEST:g} m from the workspace's centre"
        else:
            return measured
        raise BadMeasurement("the robot", np.ravel(measured), valid)
