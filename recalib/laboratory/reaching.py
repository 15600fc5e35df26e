"""Inverse kinematics of a calibrated arm, started from measured postures."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from recalib.arrays import array_of, check_rotations, check_size
from recalib.errors import RecalibError
from recalib.files.quantities import LENGTH
from recalib.identification.calibration import Calibration
from recalib.identification.model.error_model import by_sight
from recalib.identification.model.linearisation import LEVER
from recalib.nominal.kinematics import Arm, Coupling
from recalib.nominal.newton import solve_groups
from recalib.nominal.poses import orientation_error
from recalib.spelling import listed

TOLERANCE = 1e-8  # m, rad
STEPS = 60
STARTS = 6  # measured postures to start from, if none is given


class NotReached(RecalibError):
    """The arm cannot reach some desired poses. Attributes: rows, counted from 1."""

    def __init__(self, rows: Sequence[int], reason: str):
        self.rows = [*rows]
        others = f", and neither can {len(self.rows) - 1} more" if len(self.rows) > 1 else ""
        super().__init__(f"row {self.rows[0]} cannot be reached{others}: {reason}")


@dataclass(frozen=True)
class Goals:
    """Desired poses: of targets in the instrument's frame, or of the tool link in the base."""

    poses: np.ndarray  # (n, 4, 4), or positions (n, 3) [m]
    postures: np.ndarray | None = None  # (n, columns) rad, m to stay near to; None: no preference
    targets: np.ndarray | None = None  # (n,) numbers of targets; None for the tool link

    @classmethod
    def of(cls, poses: ArrayLike, near: ArrayLike | None, coupling: Coupling) -> "Goals":
        """Goals from one pose or many. Raises InvalidSetting: wrong shape, rotation or unit."""
        shapes = ("n", 4, 4), (4, 4), ("n", 3), (3,)
        given = array_of("poses", poses, *shapes)
        if given.shape[-2:] == (4, 4):
            check_rotations("poses", given)
        if given.ndim == 1 or given.shape == (4, 4):
            given = given[None]
        goals = cls(given)
        check_size("poses", goals.positions, LENGTH)
        if near is None:
            return goals
        postures = coupling.given("near", near, (len(given),), *[()] * (len(given) == 1))
        return cls(given, np.atleast_2d(postures))

    def __len__(self) -> int:
        return len(self.poses)

    def __getitem__(self, rows: np.ndarray) -> "Goals":
        given = {name: array[rows] for name, array in vars(self).items() if array is not None}
        return replace(self, **given)

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) m."""
        return self.poses if self.poses.ndim == 2 else self.poses[:, :3, 3]

    def reachable(self, arm: Arm) -> "Goals":
        """The goals that an arm can reach: only positions if it has fewer than six joints."""
        few = len(arm.coupling.columns) < 6
        return replace(self, poses=self.positions) if few else self


def poses_at(
    calibration: Calibration, joints: np.ndarray, targets: np.ndarray | int | None
) -> np.ndarray:
    """Poses (n, 4, 4) [m] of targets (numbers), or of the tool (None), at joints (n, columns)."""
    every = calibration.model.nominal.coupling.joints(joints)
    if targets is None:
        return calibration.forward(every)
    return calibration.predict(every, np.broadcast_to(targets, len(every)))


def reach(
    calibration: Calibration, learned: np.ndarray, goals: Goals
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve for joints from each start in turn, until every goal is reached within joint limits.

    Without given postures, the starts are learned ones (n, columns) [rad, m]. Returns the best
    joints (n, columns) [rad, m], their errors (n,) [m or rad], and whether each goal is reached.
    """
    arm, simple = calibration.model.nominal, goals.reachable(calibration.model.nominal)
    starts = _nearest(calibration, learned, goals) if goals.postures is None else [goals.postures]
    lower, upper = arm.coupling.limits
    found, errors = starts[0].copy(), np.full(len(goals), np.inf)
    reached = np.zeros(len(goals), dtype=bool)
    for start in starts:
        rows = np.flatnonzero(~reached)
        if not len(rows):
            break
        begin = start[rows]
        if goals.poses.ndim > simple.poses.ndim:  # first the whole pose, then its position alone
            begin, _ = _newton(calibration, goals[rows], begin)
        tried, remaining = _newton(calibration, simple[rows], begin)
        within = ((tried >= lower) & (tried <= upper)).all(axis=1) & (remaining <= TOLERANCE)
        better = within | (remaining < errors[rows])
        found[rows[better]], errors[rows[better]] = tried[better], remaining[better]
        reached[rows] = within
    return found, errors, reached


def reach_all(calibration: Calibration, learned: np.ndarray, goals: Goals) -> np.ndarray:
    """Joint coordinates (n, columns) [rad, m] that reach all goals. Raises NotReached."""
    found, errors, reached = reach(calibration, learned, goals)
    if reached.all():
        return found
    arm, rows = calibration.model.nominal, np.flatnonzero(~reached)
    goal, joints = goals[rows[:1]], found[rows[0]]
    if errors[rows[0]] > TOLERANCE:
        (pose,) = poses_at(calibration, joints[None], goal.targets)
        (wanted,) = goal.reachable(arm).poses
        gap = f"{1e3 * np.linalg.norm(pose[:3, 3] - goal.positions[0]):.4g} mm"
        if wanted.ndim == 2:
            gap += f" and {np.degrees(orientation_error(pose, wanted)):.4g} deg"
        raise NotReached((rows + 1).tolist(), f"the nearest posture found is {gap} away")
    low, high = arm.coupling.limits
    names = listed(np.array(arm.coupling.columns)[(joints < low) | (joints > high)], "and")
    raise NotReached((rows + 1).tolist(), f"only beyond the limits of {names}")


def _nearest(calibration: Calibration, learned: np.ndarray, goals: Goals) -> list[np.ndarray]:
    """For each start, learned postures (n, joints) near the goals; the nearest come first."""
    count, dimensions = min(STARTS, len(learned)), goals.poses.ndim
    found = np.empty((count, len(goals), learned.shape[1]))
    for target, rows in by_sight(goals.targets, len(goals)):
        poses = poses_at(calibration, learned, None if goals.targets is None else target)
        wanted = _features(goals.poses[rows], dimensions)
        nearest = KDTree(_features(poses, dimensions)).query(wanted, k=range(1, 1 + count))[1]
        found[:, rows] = learned[nearest.T]
    return list(found)


def _features(poses: np.ndarray, dimensions: int) -> np.ndarray:
    """Positions (n, 3), or with 3 dimensions also scaled axes (n, 12): a turn moves two axes."""
    if poses.ndim == 2:
        return poses
    places = poses[:, :3, 3]
    if dimensions == 2:
        return places
    axes = poses[:, :3, :3].reshape(len(poses), 9) * LEVER / np.sqrt(2)
    return np.concatenate([places, axes], axis=1)


def _newton(
    calibration: Calibration, goals: Goals, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Newton steps of least norm, for each goal by itself: redundant joints stay near the start."""
    coupling = calibration.model.nominal.coupling

    def kinematics(rows: np.ndarray, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        every = coupling.joints(joints[:, 0])
        if goals.targets is None:
            poses, jacobians = calibration.forward_and_jacobian(every)
        else:
            poses, jacobians = calibration.predict_and_jacobian(every, goals.targets[rows])
        return poses[:, None], (jacobians @ coupling.gains)[:, None]

    found, errors = solve_groups(kinematics, goals.poses[:, None], start[:, None], TOLERANCE, STEPS)
    return found[:, 0], errors[:, 0]
