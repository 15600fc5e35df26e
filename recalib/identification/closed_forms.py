"""The frames of the instrument and of the targets, in closed form.

T_i = (R_i, t_i) is the pose of the tool by the nominal arm. X is the pose of the arm's base in the
frame of the instrument, and Z_k that of target k on the tool, at z_k. Both are unknown. Apart from
the errors of the arm, they satisfy one of these equations.

- Poses: Y_i = X T_i Z_k. The rotations are leading singular vectors of a sum of Kronecker products
  (Shah 2013, Solving the robot-world/hand-eye calibration problem using the Kronecker product);
  the translations follow by linear least squares.
- Positions: y_i = X (t_i + R_i z_k). They are linear in the inverse of X and in z_k if the rotation
  may be any matrix, which is then replaced by the nearest rotation; or align points with z_k = 0.
- A ball in socket s: c_s = t_i + R_i z_k, which is linear.

If X or Z_k is known, the other one follows by aligning points and axes, or linearly.
"""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.model.frames import BASE, HELD, LINK, UNKNOWN, Frames, nearest_rotation
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations

OPEN = 1e-2  # singular values below this fraction of the largest leave a direction undetermined
# The second singular value over the first: both are equal if the tool turns about one axis only.
UNDECIDED = 0.9999
GUESSED = UNKNOWN[0], HELD  # prior deviations of a point, which has no orientation


def solutions(
    tool: np.ndarray,
    observations: Observations,
    base: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> Iterator[Frames]:
    """Candidate frames that fit the rows; none if the rows do not determine them.

    Args:
        tool: (n, 4, 4) m, nominal poses of the tool.
        observations: the measurements at these poses.
        base: (4, 4) m, in the frame of the instrument, if known.
        target: (4, 4) m, in the frame of the tool, if known, the same for all targets.
    """
    if observations.sockets is not None:
        yield _by_sockets(tool, observations, observations.sockets, target)
    elif base is not None and target is not None:
        yield Frames(base, np.tile(target, (observations.targets.max() + 1, 1, 1)))
    elif target is not None:
        yield _aligned(tool @ target, observations, target)
    elif base is not None:
        yield _placed(base[:3, :3], tool, observations, base)
    else:
        by_poses = turns_by_poses(tool, observations) if observations.kinds == 2 else []
        for turn in by_poses or _turns_by_positions(tool, observations):
            yield _placed(turn, tool, observations, None)


def turns_by_poses(tool: np.ndarray, observations: Observations) -> list[np.ndarray]:
    """The rotation (3, 3) of X, from the most measured target; empty if it is undetermined."""
    rows = observations.targets == np.bincount(observations.targets).argmax()
    # solves X R_i = Y_i Z' in the least squares sense, with each matrix flattened by rows
    products = np.einsum("nij,nkl->ikjl", observations.rotations[rows], tool[rows, :3, :3])
    left, values, _ = np.linalg.svd(products.reshape(9, 9))
    if values[1] >= UNDECIDED * values[0]:
        return []
    turn = left[:, 0].reshape(3, 3)
    return [nearest_rotation(turn * np.sign(np.linalg.det(turn)))]


def _turns_by_positions(tool: np.ndarray, observations: Observations) -> list[np.ndarray]:
    """Rotations (3, 3) of X from positions: with z_k = 0, and with X relaxed to any matrix."""
    turns, points, count = tool[:, :3, :3], tool[:, :3, 3], len(observations)
    measured = observations.positions
    # X' y - R_i z_k + b = t_i
    matrix = np.kron(np.eye(3), measured[:, None]).reshape(count, 3, 9)
    unit = np.tile(np.eye(3), (count, 1, 1))
    system = np.concatenate([matrix, unit, _by_number(-turns, observations.targets)], axis=-1)
    back = _least_squares(system, points)[:9].reshape(3, 3)
    return [nearest_rotation(_across(measured, points)), nearest_rotation(back).T]


def _aligned(target_poses: np.ndarray, observations: Observations, target: np.ndarray) -> Frames:
    """Frames from the nominal poses (n, 4, 4) of a target whose pose on the tool is known."""
    points = target_poses[:, :3, 3]
    across = _across(observations.positions, points)
    if observations.kinds == 2:
        turned = observations.rotations @ target_poses[:, :3, :3].swapaxes(1, 2)
        across = across + LEVER**2 * turned.sum(axis=0)
    base = np.eye(4)
    base[:3, :3] = nearest_rotation(across)
    base[:3, 3] = (observations.positions - points @ base[:3, :3].T).mean(axis=0)
    targets = np.tile(target, (observations.targets.max() + 1, 1, 1))
    return Frames(base, targets, base_deviations=UNKNOWN, base_unknown=True)


def _placed(
    turn: np.ndarray, tool: np.ndarray, observations: Observations, known: np.ndarray | None
) -> Frames:
    """Frames from the rotation (3, 3) of X, or all of X, by y_i - X t_i = x + X R_i z_k."""
    turned = turn @ tool[:, :3, :3]
    goal = observations.positions - tool[:, :3, 3] @ turn.T
    system = _by_number(turned, observations.targets)
    if known is None:  # a shift that both could explain goes to the instrument, not the targets
        common, middle = system.mean(axis=0), goal.mean(axis=0)
        points = _smallest(system - common, goal - middle)
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = turn, middle - common @ points
        points = points.reshape(-1, 3)
    else:
        base, points = known, _least_squares(system, goal - known[:3, 3]).reshape(-1, 3)
    targets = np.tile(np.eye(4), (len(points), 1, 1))
    targets[:, :3, 3] = points
    if observations.kinds == 2:
        between = turned.swapaxes(1, 2) @ observations.rotations
        for number, pose in enumerate(targets):
            turns = Rotation.from_matrix(between[observations.targets == number])
            pose[:3, :3] = turns.mean().as_matrix()
    return Frames(
        base,
        targets,
        base_deviations=UNKNOWN if known is None else BASE,
        target_deviations=UNKNOWN if observations.kinds == 2 else GUESSED,
        base_unknown=known is None,
        targets_unknown=True,
    )


def _by_sockets(
    tool: np.ndarray, observations: Observations, numbers: np.ndarray, target: np.ndarray | None
) -> Frames:
    """Frames of balls, and centres of sockets in the base frame, by c_s - R_i z_k = t_i."""
    unit = np.tile(np.eye(3), (len(observations), 1, 1))
    targets = np.tile(
        np.eye(4) if target is None else target, (observations.targets.max() + 1, 1, 1)
    )
    centres = _by_number(unit, numbers)
    if target is not None:
        sockets = _least_squares(centres, (tool @ target)[:, :3, 3]).reshape(-1, 3)
        return Frames(np.eye(4), targets, sockets, (HELD, HELD), LINK, base_unknown=True)
    system = np.concatenate([_by_number(-tool[:, :3, :3], observations.targets), centres], axis=-1)
    found = _least_squares(system, tool[:, :3, 3]).reshape(-1, 3)
    targets[:, :3, 3], sockets = found[: len(targets)], found[len(targets) :]
    return Frames(np.eye(4), targets, sockets, (HELD, HELD), GUESSED, True, True)


def _across(measured: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Cross-covariance (3, 3), unnormalised, of points (n, 3) and their measured positions."""
    return (measured - measured.mean(axis=0)).T @ (points - points.mean(axis=0))


def _by_number(blocks: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Rows (n, 3, 3 * numbers): blocks (n, 3, 3) in the columns of their numbers, else zeros."""
    placed = np.zeros((len(blocks), 3, np.max(numbers) + 1, 3))
    placed[np.arange(len(blocks)), :, numbers] = blocks
    return placed.reshape(len(blocks), 3, -1)


def _least_squares(system: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """The minimum-norm least-squares solution (m,) of a system (n, 3, m) for a goal (n, 3)."""
    return np.linalg.lstsq(system.reshape(goal.size, -1), goal.ravel(), rcond=OPEN)[0]


def _smallest(turned: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """The same for a system of rotations about their mean, which may be zero altogether."""
    left, values, right = np.linalg.svd(turned.reshape(goal.size, -1), full_matrices=False)
    determined = values > OPEN * np.sqrt(2 * len(goal))
    return right[determined].T @ (left[:, determined].T @ goal.ravel() / values[determined])
