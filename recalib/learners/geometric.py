"""Identification of the arm's geometry.

To reach a pose, the learner asks the identified arm for the joint angles that it needs there, and
commands the pose that the nominal kinematics give these angles.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np

from recalib.identification.calibration import Calibration, angles_for
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.observations import Observations
from recalib.interfaces import State
from recalib.learners.experience import Experience, is_due
from recalib.learners.observer import Observer
from recalib.nominal.controller import Controller


class GeometricLearner(Observer):
    """An error model for each run, identified from joint angles commanded and poses achieved.

    It knows the nominal kinematics and the controller: a command is sent to have the controller
    choose joint angles, and what these are follows from the nominal kinematics.

    Args:
        runs: how many independent trainings.
        controller: the nominal controller.

    Attributes:
        calibrations: of each run; None where nothing has been learned.
    """

    kind = "geometric"

    def __init__(self, runs: int, controller: Controller):
        self._controller = controller
        self._experience = Experience(
            runs, len(controller.robot.joints)
        )  # of joint angles and achieved coordinates
        self.calibrations: list[Calibration | None] = [None] * runs

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        commands = desired.copy()
        known = [
            run for run, calibration in enumerate(self.calibrations) if calibration is not None
        ]
        if known:
            poses = self._controller.robot.workspace.to_poses(desired[known])
            calibrations = [self.calibrations[run] for run in known]
            commands[known] = self._controller.commands_for(
                desired[known], partial(angles_for, calibrations, poses)
            )
        return commands

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        before = self._experience.moves
        self._experience.add(self._angles(commands), achieved, executed)
        if is_due(before, self._experience.moves):
            for run, last in enumerate(self.calibrations):
                angles, coordinates = self._experience.of(run)
                if len(angles):
                    measured = self._controller.robot.workspace.to_poses(coordinates)
                    self.calibrations[run] = self._calibrate(angles, measured, last)

    def settings(self) -> dict:
        """It has none; its controller is the robot's."""
        return {}

    def state(self) -> list[State]:
        """For each run its moves and, once there is one, its calibration."""
        return [
            {"moves": moves, "calibration": calibration and calibration.state()}
            for moves, calibration in zip(self._experience.state(), self.calibrations, strict=True)
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        arm = self._controller.robot.arm
        self._experience.restore([state["moves"] for state in states])
        self.calibrations = [
            Calibration.restore(arm, state["calibration"]) if state.get("calibration") else None
            for state in states
        ]

    def _calibrate(
        self, angles: np.ndarray, measured: np.ndarray, last: Calibration | None
    ) -> Calibration:
        model = ErrorModel(self._controller.robot.arm, OFFSETS)
        return Calibration(
            model, identify(model, Observations(angles, measured), last and last.estimate)
        )

    def _angles(self, commands: np.ndarray) -> np.ndarray:
        """Joint angles (run, move, joint) [rad] that the controller chooses for the commands."""
        return self._controller.targets(commands).angles
