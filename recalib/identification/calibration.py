"""A calibrated arm: what it does, and the joint angles that it needs to do what is desired."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.error_model import JOINT_WAVES, ErrorModel, JointTerms
from recalib.identification.estimation import LEAST_NOISE, Estimate, displacements, identify
from recalib.interfaces import State
from recalib.nominal.kinematics import Arm
from recalib.nominal.newton import solve_groups
from recalib.regression import Process, is_time_to_search

STEPS = 10
TOLERANCE = 1e-9  # m, rad
FEWEST = 16  # measurements to see a pattern in what a model leaves
# A gain in log evidence, over the root of the number of further parameters, that is no chance.
CONVINCING = 2.5
DOUBTFUL = 0.3  # the weight of a measurement below which no pattern is learned from it


@dataclass(frozen=True)
class Calibration:
    """An error model with its parameters identified, and a Gaussian process of what it leaves.

    Attributes:
        model: the error model.
        estimate: what is known of its parameters.
        residual: from joint angles [rad] to displacements over the estimate's noise; None where
            nothing is left but noise.
    """

    model: ErrorModel
    estimate: Estimate
    residual: Process | None = None

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m].

        Args:
            angles: (n, 6) rad in which the controller believes.
        """
        return self._moved(self.model.predict(self.estimate.parameters, angles), angles)

    def forward_and_jacobian(self, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as `forward`, and Jacobians (n, 6, 6) of the arm with its joints there.

        They leave out that joint errors and the residual change with the angles, too: slowly.
        """
        parameters = self.estimate.parameters
        standing = self.model.standing(parameters, angles, self.model.terms(angles))
        poses, jacobians = self._arm.forward_and_jacobian(standing)
        return self._moved(poses, angles), jacobians

    @cached_property
    def _arm(self) -> Arm:
        return self.model.arm(self.estimate.parameters)

    def _moved(self, poses: np.ndarray, angles: np.ndarray) -> np.ndarray:
        if self.residual is None:
            return poses
        by = self.residual.predict(angles) * np.repeat(self.estimate.noise, 3)
        moved = poses.copy()
        moved[:, :3, 3] += by[:, :3]
        if by.shape[1] == 6:
            moved[:, :3, :3] = Rotation.from_rotvec(by[:, 3:]).as_matrix() @ poses[:, :3, :3]
        return moved

    def state(self) -> State:
        """All of it, as named arrays."""
        return {
            "terms": np.array(self.model.names),
            "estimate": vars(self.estimate),
            "residual": self.residual and self.residual.state(),
        }

    @classmethod
    def restore(cls, arm: Arm, state: State) -> "Calibration":
        """What `state` returned, for the same nominal arm."""
        terms = {name: JOINT_WAVES[name] for name in state["terms"].tolist()}
        estimate, residual = Estimate(**state["estimate"]), state.get("residual")
        return cls(ErrorModel(arm, terms), estimate, residual and Process(**residual))


def angles_for(
    calibrations: Sequence[Calibration], poses: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Joint angles (run, n, 6) [rad] that the controller has to believe in to reach poses.

    By Newton's method, with the Jacobian of each run's arm alone. Where nothing reaches the pose,
    the best angles that were met.

    Args:
        calibrations: one for each run.
        poses: (run, n, 4, 4) of the tool in the base frame [m].
        start: (run, n, 6) rad nearby.
    """

    def look(runs, angles):
        each = (
            calibrations[run].forward_and_jacobian(own)
            for run, own in zip(runs, angles, strict=True)
        )
        return tuple(map(np.stack, zip(*each, strict=True)))

    return solve_groups(look, poses, start, TOLERANCE, STEPS)[0]


def calibrate(
    arm: Arm,
    candidates: Sequence[JointTerms],
    angles: np.ndarray,
    measured: np.ndarray,
    last: Calibration | None = None,
) -> Calibration:
    """The calibration of a nominal arm by the most probable of several error models.

    A model with more terms has to be far more probable: where geometry is all that is wrong, only
    geometry is used. What the model leaves goes to a Gaussian process if that is more probable than
    noise.

    Args:
        candidates: joint terms of the error models, the simplest first.
        angles: (n, 6) rad in which the controller believed.
        measured: poses (n, 4, 4) or positions (n, 3) [m] of the tool in the base frame.
        last: a calibration from fewer measurements, to start from. The hyperparameters of its
            process are kept until the number of measurements has doubled.

    Raises BadMeasurement: no numbers, or grossly off; or none at all.
    """
    best = None
    for terms in candidates:
        model = ErrorModel(arm, terms)
        estimate = identify(model, angles, measured, last and last.estimate)
        if best is None or estimate.log_evidence - best.estimate.log_evidence > _chance(
            best.estimate, estimate
        ):
            best = Calibration(model, estimate)
    return replace(best, residual=_residual(best, angles, measured, last))


def _chance(poorer: Estimate, richer: Estimate) -> float:
    """The gain in log evidence that further parameters may make by chance.

    Idle ones gain, too, since the deviations of their prior are fitted to the data.
    """
    return CONVINCING * np.sqrt(len(richer.parameters) - len(poorer.parameters))


def _residual(
    calibration: Calibration, angles: np.ndarray, measured: np.ndarray, last: Calibration | None
) -> Process | None:
    estimate = calibration.estimate
    good = estimate.weights > DOUBTFUL
    search = is_time_to_search(0 if last is None else len(last.estimate.weights), len(angles))
    if (
        good.sum() < FEWEST
        or np.all(estimate.noise <= LEAST_NOISE)
        or not (search or last.residual)
    ):
        return None
    misses = displacements(calibration.forward(angles[good]), measured[good]) / np.repeat(
        estimate.noise, 3
    )
    process = Process(angles[good], misses, None if search else last.residual.hyperparameters)
    return process if process.gain > 0 else None
