"""Commands for an unchanged controller that take the real arm to desired poses.

The paper's own idea: the controller gets a *fake* pose, from which its nominal kinematics make the
joint coordinates that take the real arm to the desired one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from recalib.errors import InvalidSetting, RecalibError, UnknownName
from recalib.identification.calibration import Calibration
from recalib.identification.checks.poses import outside_of
from recalib.identification.model.error_model import by_sight
from recalib.identification.model.linearisation import LEVER
from recalib.laboratory.correction.archive import Correction
from recalib.laboratory.tables.measurements import STILL, Measurements
from recalib.nominal.kinematics import Arm
from recalib.nominal.newton import solve_groups
from recalib.nominal.poses import orientation_error, position_error
from recalib.spelling import counted, listed

TOLERANCE = 1e-8  # m, rad
STEPS = 60
STARTS = 6  # learned postures to start from, where no posture is given
NEAR = 0.05  # m from a pose to where the joints beside it take the arm, if these are alike
BETTER = 0.1  # so much nearer they are where both belong together, and not a tool's length beside
MARGIN = 0.05  # beyond the range learned from, as a part of it


class NotReached(RecalibError):
    """Desired poses that the arm cannot take. Attributes: rows, counted from 1."""

    def __init__(self, rows: Sequence[int], reason: str):
        self.rows = [*rows]
        others = f", and neither can {len(self.rows) - 1} more" if len(self.rows) > 1 else ""
        super().__init__(f"row {self.rows[0]} cannot be reached{others}: {reason}")


@dataclass(frozen=True)
class Commands:
    """What to send.

    Attributes:
        joints: (n, joints) rad, or m where a joint slides, that the controller has to assume.
        poses: (n, 4, 4) m, which its nominal kinematics give them in the base: the fake poses.
        beyond: (n, joints) rad, or m where a joint slides, by how much it leaves the range that was
            learned from; zero up to a twentieth of that range.
        turned: (n,) rad, how far from a desired rotation an arm of fewer than six joints stays.
        outside: (n, 2) m and rad, how far the desired pose is from those that were measured.
    """

    joints: np.ndarray
    poses: np.ndarray
    beyond: np.ndarray
    turned: np.ndarray
    outside: np.ndarray


def correct(correction: Correction, desired: Measurements, in_instrument: bool = False) -> Commands:
    """Commands that take the identified arm to what is desired.

    Args:
        desired: poses or positions of the tool link in the arm's base, with joint coordinates to
            stay near to, if there are any; or joint coordinates alone, which mean the pose that
            they give the nominal arm. Arms of fewer than six joints are taken to the position, with
            the rotation as near as they can.
        in_instrument: the poses or positions are those of targets in the instrument's frame, as
            they were measured. That needs no knowledge of the base or the tool link.

    Raises NotReached; where frame and desired poses do not go together, InvalidSetting and
    UnknownName.
    """
    _check_frame(correction, desired, in_instrument)
    found = reach(correction, desired, in_instrument)
    goals, turned = _goals(correction.arm, desired), np.zeros(len(found))
    targets = _targets(correction, desired) if in_instrument else None
    far = np.zeros((len(found), 2))
    for target, rows in by_sight(targets, len(found)):
        its = None if targets is None else np.full(len(correction.learned), target)
        known = _poses(correction.calibration, correction.learned, its)
        far[rows] = outside_of(known, goals[rows])
    if goals.ndim == 3:
        turned = orientation_error(_poses(correction.calibration, found, targets), goals)
    low, high = correction.learned.min(axis=0), correction.learned.max(axis=0)
    outside = np.maximum(low - found, found - high)
    beyond = np.where(outside > MARGIN * (high - low), outside, 0.0)
    return Commands(found, correction.arm.forward(found), beyond, turned, far)


def outside_measured(commands: Commands) -> str | None:
    """The commands whose poses are not among those that were measured, in words."""
    if not (count := np.count_nonzero(commands.outside.any(axis=1))):
        return None
    parts = zip(("", "turned "), (1e3, 180 / np.pi), ("mm", "deg"), commands.outside.T, strict=True)
    farthest = [
        f"row {far.argmax() + 1} by {how}{scale * far.max():.3g} {unit}"
        for how, scale, unit, far in parts
        if far.any()
    ]
    return (
        f"{count} of {counted(len(commands.outside), 'command')} take the arm to poses outside"
        f" those measured, where its errors are unknown; the farthest: {' and '.join(farthest)}"
    )


def beyond_measured(correction: Correction, commands: Commands) -> str | None:
    """The commands that leave the range that was learned from, and the farthest, in words."""
    rows = np.flatnonzero(commands.beyond.any(axis=1))
    if not len(rows):
        return None
    low, high = correction.learned.min(axis=0), correction.learned.max(axis=0)
    parts = commands.beyond / np.maximum(high - low, STILL)
    row, joint = np.unravel_index(parts.argmax(), parts.shape)
    scale, unit = (1e3, "mm") if correction.arm.slides[joint] else (180 / np.pi, "deg")
    low, high, far = (scale * its[joint] for its in (low, high, commands.beyond[row]))
    joints = correction.arm.joints
    names = listed(np.array(joints)[commands.beyond.any(axis=0)], "and")
    leave = "leaves" if len(rows) == 1 else "leave"
    return (
        f"{len(rows)} of {counted(len(commands.beyond), 'command')} {leave} the measured range of"
        f" {names}; the farthest is row {row + 1}, with {joints[joint]} {far:.3g} {unit}"
        f" beyond {low:.4g} to {high:.4g} {unit}"
    )


def reach(correction: Correction, desired: Measurements, in_instrument: bool) -> np.ndarray:
    """Joint coordinates (n, joints) of what is desired. Raises as `correct`."""
    targets = _targets(correction, desired) if in_instrument else None
    found, errors, reached = solve(correction, desired, targets)
    if reached.all():
        return found
    rows = np.flatnonzero(~reached)
    first, model = rows[0], correction.arm.model
    if errors[first] > TOLERANCE:
        its = None if targets is None else targets[[first]]
        (pose,) = _poses(correction.calibration, found[[first]], its)
        gap = _gap(pose, _reachable(correction.arm, _goals(correction.arm, desired))[first])
        raise NotReached((rows + 1).tolist(), f"the nearest posture found is {gap} away")
    low, high = model.lowerPositionLimit, model.upperPositionLimit
    outside = (found[first] < low) | (found[first] > high)
    names = listed(np.array(correction.arm.joints)[outside], "and")
    raise NotReached((rows + 1).tolist(), f"only beyond the limits of {names}")


def unidentifiable_ends(correction: Correction) -> str | None:
    """The ends of the arm whose errors are unknown, in words: commands in the base have these."""
    frames = correction.calibration.frames
    positions_alone = len(correction.calibration.estimate.noise) == 1
    ends = {
        "the arm's base": frames.base_unknown or len(frames.sockets),
        "the tool link": frames.targets_unknown,
        "how the tool link is turned": positions_alone and not frames.targets_unknown,
    }
    return " and ".join(end for end, unknown in ends.items() if unknown) or None


def solve(
    correction: Correction, desired: Measurements, targets: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As `correct`, whether the arm gets there or not: from each start in turn, until it does.

    Args:
        targets: (n,) numbers of those that are desired in the instrument's frame; None where the
            tool link is, in the base.

    Returns joint coordinates (n, joints), their errors (n,) in m or rad, and whether a desired pose
    is reached within the arm's limits (n,).
    """
    arm, joints, full = correction.arm, desired.coordinates, _goals(correction.arm, desired)
    goals = _reachable(arm, full)
    starts = [joints] if joints is not None else _nearest(correction, full, targets)
    lower, upper = arm.model.lowerPositionLimit, arm.model.upperPositionLimit
    found, errors = starts[0].copy(), np.full(len(goals), np.inf)
    reached = np.zeros(len(goals), dtype=bool)
    for start in starts:
        rows = np.flatnonzero(~reached)
        if not len(rows):
            break
        its = None if targets is None else targets[rows]
        begin = start[rows]
        if full.ndim > goals.ndim:  # the least that is left of a pose, and then its position
            begin, _ = _newton(correction.calibration, full[rows], its, begin)
        tried, remaining = _newton(correction.calibration, goals[rows], its, begin)
        within = ((tried >= lower) & (tried <= upper)).all(axis=1) & (remaining <= TOLERANCE)
        better = within | (remaining < errors[rows])
        found[rows[better]], errors[rows[better]] = tried[better], remaining[better]
        reached[rows] = within
    return found, errors, reached


def _check_frame(correction: Correction, desired: Measurements, in_instrument: bool) -> None:
    """Raise InvalidSetting where joints take the arm to the poses, but in the other frame."""
    calibration, joints, goals = correction.calibration, desired.coordinates, desired.positions
    several = len(correction.targets) > 1 or len(calibration.frames.sockets)
    if joints is None or goals is None or several:
        return
    ends = calibration.forward(joints), calibration.predict(joints)
    in_base, to_instrument = (np.median(np.linalg.norm(e[:, :3, 3] - goals, axis=1)) for e in ends)
    own, other = (to_instrument, in_base) if in_instrument else (in_base, to_instrument)
    if other < min(NEAR, BETTER * own) and own > NEAR:
        frame, right = ("instrument", "base") if in_instrument else ("base", "instrument")
        raise InvalidSetting(
            "frame",
            frame,
            f"{right}, where the joints in the table take the arm to the poses beside them; in the"
            f" frame given, they are {1e3 * own:.0f} mm off; try: a table without joints, if they"
            " are only to stay near to",
        )


def _goals(arm: Arm, desired: Measurements) -> np.ndarray:
    """Poses (n, 4, 4) or positions (n, 3) [m] that are desired."""
    goals = desired.measured
    if goals is None:
        goals = arm.forward(desired.joints)
    return goals


def _reachable(arm: Arm, goals: np.ndarray) -> np.ndarray:
    """What an arm reaches of poses (n, 4, 4) [m]: with fewer than six joints, positions (n, 3)."""
    return goals[:, :3, 3] if arm.model.nv < 6 and goals.ndim == 3 else goals


def _targets(correction: Correction, desired: Measurements) -> np.ndarray:
    """The number (n,) of the target that each row is about."""
    names = correction.targets
    if len(correction.calibration.frames.sockets):
        raise InvalidSetting("frame", "instrument", "base: a ball in sockets had no instrument")
    if desired.positions is None:
        raise InvalidSetting("x, y, z", None, "where a target should be, to the instrument")
    frames, kinds = correction.calibration.frames, len(correction.calibration.estimate.noise)
    if desired.rotations is not None and frames.targets_unknown and kinds == 1:
        valid = "none: from positions alone nobody knows how a target is turned"
        raise InvalidSetting("rotation", "that of a target", valid)
    if desired.targets is None:
        if len(names) > 1:
            raise InvalidSetting("column target", None, f"{listed(names, 'or')} in each row")
        return np.zeros(len(desired), dtype=int)
    for name in desired.targets:
        if name not in names:
            raise UnknownName("target", str(name), names)
    return np.array([names.index(name) for name in desired.targets])


def _nearest(
    correction: Correction, goals: np.ndarray, targets: np.ndarray | None
) -> list[np.ndarray]:
    """Learned postures (n, joints) near goals, the nearest first."""
    learned, calibration = correction.learned, correction.calibration
    count = min(STARTS, len(learned))
    found = np.empty((count, len(goals), learned.shape[1]))
    for target, rows in by_sight(targets, len(goals)):
        its = None if targets is None else np.full(len(learned), target)
        tree = KDTree(_features(_poses(calibration, learned, its), goals.ndim))
        wanted = _features(goals[rows], goals.ndim)
        found[:, rows] = learned[tree.query(wanted, k=range(1, 1 + count))[1].T]
    return list(found)


def _poses(calibration: Calibration, joints: np.ndarray, targets: np.ndarray | None) -> np.ndarray:
    """Poses (n, 4, 4) [m] of the tool in the base, or of targets (n,) to the instrument."""
    return calibration.forward(joints) if targets is None else calibration.predict(joints, targets)


def _features(poses: np.ndarray, dimensions: int) -> np.ndarray:
    """Positions (n, 3), and with three dimensions the axes (n, 12), of which a turn moves two."""
    if poses.ndim == 2:
        return poses
    places = poses[:, :3, 3]
    if dimensions == 2:
        return places
    axes = poses[:, :3, :3].reshape(len(poses), 9) * LEVER / np.sqrt(2)
    return np.concatenate([places, axes], axis=1)


def _newton(
    calibration: Calibration, goals: np.ndarray, targets: np.ndarray | None, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Steps of least norm, for each goal by itself: what it leaves free stays near the start."""

    def kinematics(rows: np.ndarray, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if targets is None:
            poses, jacobians = calibration.forward_and_jacobian(joints[:, 0])
        else:
            poses, jacobians = calibration.predict_and_jacobian(joints[:, 0], targets[rows])
        return poses[:, None], jacobians[:, None]

    found, errors = solve_groups(kinematics, goals[:, None], start[:, None], TOLERANCE, STEPS)
    return found[:, 0], errors[:, 0]


def _gap(pose: np.ndarray, goal: np.ndarray) -> str:
    """From a pose (4, 4) to a pose or position that is desired, in words."""
    if goal.ndim == 1:
        return f"{1e3 * np.linalg.norm(pose[:3, 3] - goal):.4g} mm"
    position, orientation = position_error(pose, goal), orientation_error(pose, goal)
    return f"{1e3 * position:.4g} mm and {np.degrees(orientation):.4g} deg"
