"""Identification of the arm's geometry, alone or with joint errors and a model of residuals.

To reach a pose, the learner solves the identified arm's inverse kinematics, and commands the pose
that the nominal kinematics have at these joint angles.
"""

import math
from collections.abc import Mapping, Sequence
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
ROUNDS = 4  # for a redundant arm; each reduces the error to some hundredths
TOLERANCE = 1e-9  # m, rad


class GeometricLearner(Refitting):
    """An error model for each run, identified from commanded joint angles and achieved poses.

    The learner knows the nominal kinematics and the controller, so it can compute the joint angles
    that the controller chooses for a command.

    Args:
        controller: the nominal controller.
        runs: number of independent trainings.

    Raises InvalidSetting if `controller` is not a Controller.
    """

    MODEL = "calibration"

    def __init__(self, controller: Controller, *, runs: int = 1):
        check_kind("controller", controller, Controller)
        super().__init__(runs=runs, sent=len(controller.robot.joints))
        self._controller = controller

    def command(self, desired: np.ndarray) -> np.ndarray:
        desired = array_of("desired", desired, (len(self.models), "n", 6))
        commands = desired.copy()
        known = {run: model for run, model in enumerate(self.models) if model is not None}
        if known:
            runs, models, robot = [*known], [*known.values()], self._controller.robot
            poses = robot.workspace.to_poses(desired[runs])
            # a redundant arm has many suitable angles; the controller's own answer selects some
            for _ in range(ROUNDS if len(robot.joints) > 6 else 1):
                angles = angles_for(models, poses, self._sent(commands[runs]))
                reached = robot.arm.forward(angles.reshape(-1, angles.shape[-1]))
                coordinates = robot.workspace.to_coordinates(reached)
                commands[runs] = coordinates.reshape(len(runs), -1, 6)
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
        """The calibration of an arm from earlier measurements; `arm` is nominal."""
        return cls._calibrate(arm, observations, None)

    def _restored(self, state: Mapping[str, Any]) -> Calibration:
        return Calibration.restore(self._controller.robot.arm, state)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs; it has no settings.

        The singularity margin is not checked again: it was accepted when the learner was trained.
        """
        return cls(Controller(robot, greatest_condition=math.inf), runs=runs)


class HybridLearner(GeometricLearner):
    """A geometric learner with a model of residuals and joint errors, such as eccentric gears.

    See `calibrate`.
    """

    @staticmethod
    def _calibrate(arm: Arm, observations: Observations, last: Calibration | None) -> Calibration:
        return calibrate(arm, (OFFSETS, JOINT_ERRORS), observations, last=last)

    @classmethod
    def identify(cls, arm: Arm, observations: Observations) -> Calibration:
        """The same for a hybrid learner, with more kinds of joint errors than in training."""
        return calibrate(arm, (OFFSETS, JOINT_ERRORS, JOINT_WAVES), observations)


def angles_for(
    calibrations: Sequence[Calibration], poses: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Joint coordinates (run, n, joints) [rad, m] that take the calibrated arms to poses.

    Newton's method uses the Jacobian of each run's calibrated arm. If a pose cannot be reached, the
    best angles of all steps are returned.

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
