"""Identification of the arm's geometry: command the nominal pose of the joint angles that the identified arm needs."""

from collections.abc import Mapping

import numpy as np

from recalib.identification.calibration import Calibration, angles_for
from recalib.identification.design import information_gains
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.interfaces import Execute
from recalib.learners.experience import Experience, is_due
from recalib.nominal.controller import Controller


class GeometricLearner:
    """An error model of the arm for each run, identified from the joint angles commanded and the poses achieved.

    It knows the nominal kinematics and the controller: a command is sent to have the controller choose joint angles, and
    what these are follows from the nominal kinematics.

    Args:
        runs: how many independent trainings.
        controller: the nominal controller.
    """

    def __init__(self, runs: int, controller: Controller):
        self._controller = controller
        self._experience = Experience(runs)  # of joint angles and achieved coordinates
        self._calibrations: list[Calibration | None] = [None] * runs

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        commands = desired.copy()
        known = [
            run for run, calibration in enumerate(self._calibrations) if calibration is not None
        ]
        if known:
            robot, calibrations = self._controller.robot, [self._calibrations[run] for run in known]
            needed = angles_for(
                calibrations, robot.workspace.to_poses(desired[known]), self._angles(desired[known])
            )
            commands[known] = robot.workspace.to_coordinates(
                robot.arm.forward(needed.reshape(-1, 6))
            ).reshape(needed.shape)
        return commands

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One move to the desired poses (run, 6); nothing is learned where it is refused."""
        commands = self.command(desired[:, None])
        outcome = execute(commands)
        robot = self._controller.robot
        before = self._experience.moves
        self._experience.add(self._angles(commands), outcome.achieved, outcome.executed)
        if is_due(before, self._experience.moves):
            for run in range(len(desired)):
                angles, achieved = self._experience.of(run)
                if len(angles):
                    measured, last = robot.workspace.to_poses(achieved), self._calibrations[run]
                    self._calibrations[run] = self._calibrate(angles, measured, last)

    def choose(self, candidates: np.ndarray) -> np.ndarray:
        """Of candidate poses (run, candidate, 6) the one for each run (run, 6) that a move to it would teach the most.

        To learn from it, hand it to `learn` as the desired pose. The first candidate, before anything is learned.
        """
        angles = self._angles(self.command(candidates))
        return np.stack(
            [
                poses[0 if calibration is None else information_gains(calibration, each).argmax()]
                for poses, each, calibration in zip(
                    candidates, angles, self._calibrations, strict=True
                )
            ]
        )

    def state(self) -> dict[str, np.ndarray]:
        """The moves and the calibration of each run."""
        arrays = self._experience.state()
        for run, calibration in enumerate(self._calibrations):
            if calibration is not None:
                arrays |= {f"{run}/{name}": value for name, value in calibration.state().items()}
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Take over what `state` returned."""
        self._experience.restore(arrays)
        for run in range(len(self._calibrations)):
            own = {
                name.split("/", 1)[1]: value
                for name, value in arrays.items()
                if name.startswith(f"{run}/")
            }
            self._calibrations[run] = (
                Calibration.restore(self._controller.robot.arm, own) if own else None
            )

    def _calibrate(
        self, angles: np.ndarray, measured: np.ndarray, last: Calibration | None
    ) -> Calibration:
        model = ErrorModel(self._controller.robot.arm, OFFSETS)
        return Calibration(model, identify(model, angles, measured, last and last.estimate))

    def _angles(self, commands: np.ndarray) -> np.ndarray:
        """Joint angles (run, move, 6) [rad] that the controller chooses for the commands (run, move, 6)."""
        return self._controller.targets(commands).angles
