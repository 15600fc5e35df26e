"""A calibrated arm: its forward kinematics, and its identification from measurements."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pinocchio as pin

from recalib.arrays import array_of
from recalib.errors import check_kind
from recalib.identification.estimation import DOUBTFUL, LEAST_NOISE, Identification, identify
from recalib.identification.model.error_model import JOINT_WAVES, ErrorModel, JointTerms, by_sight
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import displacements
from recalib.identification.model.observations import Observations
from recalib.loop.interfaces import State
from recalib.nominal.kinematics import Arm
from recalib.numerics.randomness import generator
from recalib.numerics.regression import Process, is_time_to_search

FEWEST = 16  # the least number of measurements to find a pattern in their residuals
MOST = 2000  # measurements for the process: memory grows with their square, time with their cube
# The least significant gain in log evidence, over the root of the number of added parameters. Even
# useless parameters gain some, since the deviations of their prior are fitted to the data.
CONVINCING = 2.5


@dataclass(frozen=True)
class Calibration:
    """An error model with identified parameters, and a Gaussian process of its residuals.

    Attributes:
        model: the error model.
        estimate: the estimate of the model's parameters.
        pattern: the process, from joint angles [rad] to residuals over the noise of the estimate;
            None if the residuals are noise.
    """

    model: ErrorModel
    estimate: Identification
    pattern: Process | None = None

    def forward(self, joints: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) [m] of the tool in the base frame, at joints (n, joints) [rad, m].

        The joints are those that the controller reports. If a frame was unknown, the arm's own base
        or tool stays nominal. Raises InvalidSetting: another shape, NaN.
        """
        angles = array_of("joints", joints, ("n", self._arm.model.nv))
        return self._moved(self._arm.forward(self._standing(angles)), angles)

    def forward_and_jacobian(self, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as in `forward`, and Jacobians (n, 6, joints) at the actual joint angles.

        The Jacobians neglect that joint errors and the pattern vary (slowly) with the joints.
        """
        poses, jacobians = self._arm.forward_and_jacobian(self._standing(joints))
        return self._moved(poses, joints), jacobians

    def predict(self, joints: np.ndarray, targets: np.ndarray | None = None) -> np.ndarray:
        """Predicted measurements: poses (n, 4, 4) [m] of targets in the instrument's frame.

        Joints are as in `forward`; targets (n,) are the numbers of the sights, by default the
        first. Raises InvalidSetting: another shape, NaN.
        """
        angles = array_of("joints", joints, ("n", self._arm.model.nv))
        poses = self.model.predict(self.estimate.parameters, angles, targets)
        return self._shifted(poses, angles, targets)

    def predict_and_jacobian(
        self, joints: np.ndarray, targets: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Poses as in `predict`, and Jacobians (n, 6, joints) as in `forward_and_jacobian`."""
        standing = self._standing(joints)
        jacobians = np.empty((len(joints), 6, joints.shape[1]))
        poses = np.empty((len(joints), 4, 4))
        for target, rows in by_sight(targets, len(joints)):
            arm = self._arms_to_targets[target]
            poses[rows], jacobians[rows] = arm.forward_and_jacobian(standing[rows])
        return self._shifted(poses, joints, targets), jacobians

    def position_covariances(
        self, joints: np.ndarray, shifted: bool, targets: np.ndarray | None = None
    ) -> np.ndarray:
        """Covariances (n, 3, 3) [m^2] of predicted positions; arguments as in `predict`.

        If `shifted`, the covariance of one shift and turn of instrument and target, common to all
        rows, is removed: the range of a camera is only as accurate as its board and lens.
        """
        model, estimate = self.model, self.estimate
        _, jacobians = model.linearise(estimate.parameters, joints, targets)
        by_position = jacobians[:, :3].reshape(-1, model.deviations.size)
        if shifted:
            ends = np.flatnonzero(model.free[: model.optics_columns.start])
            shifts = np.linalg.qr(by_position[:, ends]).Q
            by_position = by_position - shifts @ (shifts.T @ by_position)
        rows = by_position.reshape(len(joints), 3, -1)
        return rows @ estimate.covariance @ rows.swapaxes(1, 2)

    def unseen(self, observations: Observations) -> float | np.ndarray:
        """Standard deviations (n,) [m] of predictions along lines of sight; 0 without cameras."""
        if observations.optics is None:
            return 0.0
        lines = observations.optics.lines
        spread = self.position_covariances(observations.joints, True, observations.targets)
        return np.sqrt(np.einsum("ni,nij,nj->n", lines, spread, lines))

    def residuals(self, observations: Observations) -> np.ndarray:
        """Residuals, measured minus predicted: (n, 3) m or (n, 6) m and rad, instrument's axes."""
        predicted = self.predict(observations.joints, observations.targets)
        residuals = displacements(predicted, observations.reached(self.frames.sockets))
        if observations.optics is None:
            return residuals
        found = self.estimate.parameters[self.model.optics_columns]
        return residuals + observations.optics.slopes @ found

    @cached_property
    def frames(self) -> Frames:
        """The identified poses of the instrument and of the targets."""
        return self.model.found(self.estimate.parameters)

    def axes(self, targets: np.ndarray) -> np.ndarray:
        """Rotations (n, 3, 3) from the first instrument's axes to each sight's instrument."""
        turns = self.frames.bases[:, :3, :3]
        between = turns @ turns[0].T
        between[0] = np.eye(3)  # exactly, without rounding
        return between[self.model.frames.sights[targets, 0]]

    @cached_property
    def _arm(self) -> Arm:
        return self.model.own_arm(self.estimate.parameters)

    @cached_property
    def _arms_to_targets(self) -> list[Arm]:
        """The arm to the target of each sight, cached: an arm is slower to make than to use."""
        numbers = range(len(self.model.frames.sights))
        return [self.model.arm(self.estimate.parameters, sight) for sight in numbers]

    def _standing(self, joints: np.ndarray) -> np.ndarray:
        return self.model.standing(self.estimate.parameters, joints)

    def _moved(self, poses: np.ndarray, joints: np.ndarray) -> np.ndarray:
        """The tool's poses, corrected by the pattern of the first target in the instrument."""
        if self.pattern is None:
            return poses
        base, target = self.frames.base, self.frames.targets[0]
        observed = self._shifted(base @ poses @ target, joints)
        return np.linalg.inv(base) @ observed @ np.linalg.inv(target)

    def _shifted(
        self, poses: np.ndarray, joints: np.ndarray, targets: np.ndarray | None = None
    ) -> np.ndarray:
        """The poses, corrected by the pattern, which is along the axes of the first instrument."""
        if self.pattern is None:
            return poses
        shifts = self.pattern.predict(joints) * np.repeat(self.estimate.noise, 3)
        if targets is not None and len(self.model.frames.further):
            shifts = turned(self.axes(targets), shifts)
        moved = poses.copy()
        moved[:, :3, 3] += shifts[:, :3]
        if shifts.shape[1] == 6:
            for pose, turn in zip(moved, shifts[:, 3:], strict=True):
                pose[:3, :3] = pin.exp3(turn) @ pose[:3, :3]
        return moved

    def state(self) -> State:
        """The whole calibration as named arrays."""
        return {
            "terms": np.array(self.model.names),
            "frames": vars(self.model.frames),
            "deviations": self.model.deviations,
            "estimate": vars(self.estimate),
            "residual": self.pattern and self.pattern.state(),
        }

    @classmethod
    def restore(cls, arm: Arm, state: State) -> "Calibration":
        """The calibration from its `state` and the same nominal arm; ValueError if parts misfit."""
        terms = {name: JOINT_WAVES[name] for name in state["terms"].tolist()}
        estimate, pattern = Identification(**state["estimate"]), state.get("residual")
        model = ErrorModel(arm, terms, Frames(**state["frames"]))
        shape = model.deviations.shape
        deviations = state.get("deviations", model.deviations)  # older files lack this key
        sizes = estimate.parameters.shape, estimate.covariance.shape, deviations.shape
        if sizes != (shape, 2 * shape, shape):
            raise ValueError("parameters of another error model")
        model.deviations[:] = deviations
        return cls(model, estimate, pattern and Process(**pattern))


def turned(turns: np.ndarray, residuals: np.ndarray) -> np.ndarray:
    """Residuals (n, 3) or (n, 6), rotated to other axes by rotations (n, 3, 3)."""
    vectors = residuals.reshape(len(turns), -1, 3)
    return np.einsum("nij,nkj->nki", turns, vectors).reshape(residuals.shape)


def calibrate(
    arm: Arm,
    candidates: Sequence[JointTerms],
    observations: Observations,
    frames: Frames | None = None,
    last: Calibration | None = None,
) -> Calibration:
    """The calibration of a nominal arm with the most probable of several error models.

    A model with more terms must be far more probable: if only the geometry is wrong, only geometry
    is used. A Gaussian process of the residuals is added if it is more probable than noise.

    Args:
        candidates: joint terms of the error models, the simplest first.
        observations: the measurements of the arm.
        frames: the frames at both ends of the arm; default: the instrument measures in the frame of
            the arm's base, and the target is at the tool frame.
        last: a calibration from fewer measurements, as the start. The hyperparameters of its
            process, or the lack of a process, are kept until `is_time_to_search`.

    Raises BadMeasurement: no measurements, numbers that are not finite, or gross errors.
    """
    start, before = (last.estimate, len(last.estimate.weights)) if last else (None, 0)
    every = calibrations(arm, candidates, observations, frames, start)
    best = every[choose(every)]
    if is_time_to_search(before, len(observations)):
        return with_pattern(best, observations)
    if last is None or last.pattern is None:
        return best
    return with_pattern(best, observations, last.pattern.hyperparameters)


def calibrations(
    arm: Arm,
    candidates: Sequence[JointTerms],
    observations: Observations,
    frames: Frames | None = None,
    start: Identification | None = None,
    weights: np.ndarray | None = None,
) -> list[Calibration]:
    """The calibrations with all error models, without a process; see `identify` for `start`.

    Raises InvalidSetting: the arm is no Arm, or the observations are no Observations.
    """
    check_kind("arm", arm, Arm)
    check_kind("observations", observations, Observations)
    models = [ErrorModel(arm, terms, frames) for terms in candidates]
    return [Calibration(model, identify(model, observations, start, weights)) for model in models]


def choose(candidates: Sequence[Calibration]) -> int:
    """The index of the most probable of calibrations from the same data, the simplest first."""
    best = 0
    for number, other in enumerate(candidates):
        added = other.model.size - candidates[best].model.size
        gain = other.estimate.log_evidence - candidates[best].estimate.log_evidence
        if gain > CONVINCING * np.sqrt(added):
            best = number
    return best


def with_pattern(
    calibration: Calibration, observations: Observations, hyperparameters: np.ndarray | None = None
) -> Calibration:
    """The calibration with a process of its residuals, if they are enough and more than noise.

    By default, the hyperparameters are the most probable ones, which take long to find.
    """
    estimate = calibration.estimate
    noise, good = estimate.noise, np.flatnonzero(estimate.weights > DOUBTFUL)
    if len(good) < FEWEST or np.all(noise <= LEAST_NOISE):
        return calibration
    if len(good) > MOST:
        good = np.sort(generator(0, "residual").permutation(good)[:MOST])
    axes = calibration.axes(observations.targets[good])
    residuals = turned(axes.swapaxes(1, 2), calibration.residuals(observations[good]))
    residuals /= np.repeat(noise, 3)
    process = Process(observations.joints[good], residuals, hyperparameters)
    return replace(calibration, pattern=process) if process.gain > 0 else calibration
