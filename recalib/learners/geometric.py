"""Identification of the arm's geometry.

To reach a pose, the learner asks the identified arm for the joint angles that it needs there, and
commands the pose that the nominal kinematics give these angles.
"""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Self

import numpy as np

from recalib.identification.calibration import Calibration, angles_for
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.observations import Observations
from recalib.learners.experience import Experience, is_due
from recalib.learners.observer import Observer
from recalib.loop.interfaces import State
from recalib.nominal.controller import Controller
from recalib.nominal.robots import Robot


class GeometricLearner(Observer):
    """An error model for each run, identified from joint angles commanded and poses achieved.

    It knows the nominal kinematics and the controller: a command is sent to have the controller
    choose joint angles, and what these are follows from the nominal kinematics.

    Args:
        controller: the nominal controller.
        runs: how many independent trainings.

    Attributes:
        calibrations: of each run; None where nothing has been learned.
    """

    def __init__(self, controller: Controller, *, runs: int = 1):
        self._controller = controller
        self._experience = Experience(
            runs, len(controller.robot.joints)
        )  # of joint angles and achieved coordinates
        self.calibrations: list[Calibration | None] = [None] * runs

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        commands = desired.copy()
        known = {run: each for run, each in enumerate(self.calibrations) if each is not None}
        if known:
            poses = self._controller.robot.workspace.to_poses(desired[[*known]])
            commands[[*known]] = self._controller.commands_for(
                desired[[*known]], partial(angles_for, [*known.values()], poses)
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

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """The learner of so many runs that has learned nothing; there are no settings.

        Its controller's singularity margin was accepted when it learned.
        """
        return cls(Controller(robot, greatest_condition=math.inf), runs=runs)

    def settings(self) -> dict[str, Any]:
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
            model, identify(model, Observations(angles, measured), last.estimate if last else None)
        )

    def _angles(self, commands: np.ndarray) -> np.ndarray:
        """Joint angles (run, move, joint) [rad] that the controller chooses for the commands."""
        return self._controller.targets(commands).angles
