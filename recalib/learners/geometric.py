"""Identification of the arm's geometry, alone or with joint errors and a model of residuals.

To reach a pose, the learner asks the identified arm for the joint angles that it needs there, and
commands the pose that the nominal kinematics give these angles.
"""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Self

import numpy as np

from recalib.arrays import array_of
from recalib.errors import check_kind
from recalib.identification.calibration import Calibration, calibrate, calibrations
from recalib.identification.model.error_model import JOINT_ERRORS, JOINT_WAVES, OFFSETS
from recalib.identification.model.observations import Observations
from recalib.learners.observer import Refitting
from recalib.nominal.controller import Controller
from recalib.nominal.kinematics import Arm
from recalib.nominal.newton import solve_groups
from recalib.nominal.robots import Robot

STEPS = 10
TOLERANCE = 1e-9  # m, rad


class GeometricLearner(Refitting):
    """An error model for each run, identified from joint angles commanded and poses achieved.

    It knows the nominal kinematics and the controller: a command is sent to have the controller
    choose joint angles, and what these are follows from the nominal kinematics.

    Args:
        controller: the nominal controller.
        runs: how many independent trainings.

    Raises InvalidSetting: something else than a controller.
    """

    MODEL = "calibration"

    def __init__(self, controller: Controller, *, runs: int = 1):
        check_kind("controller", controller, Controller)
        super().__init__(runs=runs, sent=len(controller.robot.joints))
        self._controller = controller

    def command(self, desired: np.ndarray) -> np.ndarray:
        desired = array_of("desired", desired, (len(self.models), "n", 6))
        commands = desired.copy()
        known = {run: each for run, each in enumerate(self.models) if each is not None}
        if known:
            poses = self._controller.robot.workspace.to_poses(desired[[*known]])
            commands[[*known]] = self._controller.commands_for(
                desired[[*known]], partial(angles_for, [*known.values()], poses)
            )
        return commands

    def _sent(self, commands: np.ndarray) -> np.ndarray:
        """Joint angles (run, move, joint) [rad] that the controller chooses for the commands."""
        return self._controller.targets(commands).angles

    def _fit(
        self, sent: np.ndarray, achieved: np.ndarray, last: Calibration | None, before: int
    ) -> Calibration:
        measured = self._controller.robot.workspace.to_poses(achieved)
        return self._calibrate(self._controller.robot.arm, Observations(sent, measured), last)

    @staticmethod
    def _calibrate(arm: Arm, observations: Observations, last: Calibration | None) -> Calibration:
        start = last.estimate if last else None
        return calibrations(arm, (OFFSETS,), observations, start=start)[0]

    @classmethod
    def identify(cls, arm: Arm, observations: Observations) -> Calibration:
        """Learn at once from earlier measurements of an arm, given the nominal one."""
        return cls._calibrate(arm, observations, None)

    def _restored(self, state: Mapping[str, Any]) -> Calibration:
        return Calibration.restore(self._controller.robot.arm, state)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs; it has no settings.

        Its controller's singularity margin was accepted when it learned.
        """
        return cls(Controller(robot, greatest_condition=math.inf), runs=runs)


class HybridLearner(GeometricLearner):
    """A geometric learner with joint errors and a model of residuals; see `calibrate`.

    Such as eccentric gears and sag.
    """

    @staticmethod
    def _calibrate(arm: Arm, observations: Observations, last: Calibration | None) -> Calibration:
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)

    @classmethod
    def identify(cls, arm: Arm, observations: Observations) -> Calibration:
        """As for a geometric learner, with more kinds of joint errors."""
        return calibrate(arm, (OFFSETS, JOINT_ERRORS, JOINT_WAVES), observations)


def angles_for(
    calibrations: Sequence[Calibration], poses: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Joint coordinates (run, n, joints) [rad, m] to send for the arm to reach poses.

    By Newton's method, with the Jacobian of each run's arm alone. If nothing reaches the pose,
    the best angles that were met.

    Args:
        calibrations: one for each run.
        poses: (run, n, 4, 4) of the tool in the base frame [m].
        start: (run, n, joints) rad, m nearby.
    """

    def kinematics(runs: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        pairs = zip(runs, angles, strict=True)
        found = [calibrations[run].forward_and_jacobian(joints) for run, joints in pairs]
        poses, jacobians = map(np.stack, zip(*found, strict=True))
        return poses, jacobians

    return solve_groups(kinematics, poses, start, TOLERANCE, STEPS)[0]
