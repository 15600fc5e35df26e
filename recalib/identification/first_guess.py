"""A first guess of where the instrument stands and where the targets sit, from anywhere.

With T_i = (R_i, t_i) the pose of the tool that the nominal arm gives, the unknown X (the arm's base
in the frame of the instrument) and Z_k (target k on the tool, at z_k) fulfil, but for the arm's own
errors,

- poses Y_i = X T_i Z_k: the rotations by the leading singular vectors of a sum of Kronecker
  products (Shah 2013, Solving the robot-world/hand-eye calibration problem using the Kronecker
  product), then the translations by linear least squares;
- positions y_i = X (t_i + R_i z_k): linear in the inverse of X and in z_k if its rotation may be
  any matrix, of which the nearest rotation is taken; or, with z_k = 0, by aligning points;
- a ball in socket s, c_s = t_i + R_i z_k: linear.

They are solved for all rows and for many small sets of them, which a few gross outliers do not all
spoil. The best, by the median of what they miss, are refined by robust least squares.
"""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.frames import HELD, UNKNOWN, Frames, nearest_rotation
from recalib.identification.linearised import LEVER, Linearised, displacements
from recalib.identification.observations import Observations
from recalib.nominal.kinematics import Arm
from recalib.randomness import generator

SETS, SPARE = 60, 3  # small sets of rows, and how many rows they have beyond the fewest
MOST = 200  # rows to guess from: more tell little more
REFINED = 6  # so many of the best guesses are refined
OPEN = 1e-2  # a singular value so small, over the largest, leaves a direction open
ROBUST, STEPS = 5e-3, 30  # m that count as gross, and evaluations, of a refinement
FARTHEST = 0.15  # m: an arm that misses by more, in the median, is not the one that is described
THIN = 5e-3  # m: the standard deviation across a line of points that are on it
# The second singular value over the first: where the tool turns about one axis alone they are equal
UNDECIDED = 0.9999


class NoFirstGuess(RecalibError):
    """Where the instrument stands, or where a target sits, cannot be told from what was seen."""


def fewest(seen: Observations) -> int:
    """How many rows a first guess needs, if each of them is of use."""
    targets = int(np.max(seen.targets, initial=0)) + 1
    if seen.measured is None:
        return targets + int(np.max(seen.sockets, initial=0)) + 2
    return (2 if seen.kinds == 2 else 5) + targets


def guess_frames(arm: Arm, seen: Observations) -> Frames:
    """The frames at both ends of the nominal arm, to start an identification from.

    Raises NoFirstGuess: too few rows, postures too much alike, or nothing that explains them.
    """
    if len(seen) < fewest(seen):
        raise NoFirstGuess(
            f"{len(seen)} rows leave open where instrument and target are;"
            f" valid: at least {fewest(seen)}"
        )
    random = generator(0, "first guess")
    if len(seen) > MOST:
        seen = seen[np.sort(random.permutation(len(seen))[:MOST])]
    tool = arm.forward(seen.joints)
    if seen.measured is not None and _is_open(tool, seen):
        raise NoFirstGuess(
            "the targets were seen along a line, which leaves open how the instrument is turned"
            " about it; valid: positions that span an area"
            + (", or postures that turn the tool about several axes" if seen.kinds == 2 else "")
        )
    found = [
        frames
        for rows in [np.arange(len(seen)), *_small_sets(seen, random)]
        for frames in _solutions(tool[rows], seen[rows])
    ]
    found.sort(key=lambda frames: _missed(frames, tool, seen))
    refined = [_refined(arm, frames, seen) for frames in found[:REFINED]]
    best = min(refined, key=lambda frames: _missed(frames, tool, seen))
    missed = _missed(best, tool, seen)
    if not missed <= FARTHEST:
        raise NoFirstGuess(
            "no place of instrument and target explains what was seen: the best leaves"
            f" {1e3 * missed:.0f} mm; valid: up to {1e3 * FARTHEST:.0f} mm, from an arm as its"
            " description has it, with the same joints, signs, zeros and units"
        )
    return best


def _small_sets(seen: Observations, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Rows in which each target, or each socket with each ball, is seen about equally often."""
    groups = seen.targets if seen.sockets is None else np.stack([seen.targets, seen.sockets])
    _, group = np.unique(groups, return_inverse=True, axis=-1)
    each = -(-(fewest(seen) + SPARE) // (group.max() + 1))
    for _ in range(SETS):
        order = random.permutation(len(seen))
        ranks = [np.flatnonzero(group[order] == one)[:each] for one in range(group.max() + 1)]
        yield order[np.concatenate(ranks)]


def _is_open(tool: np.ndarray, seen: Observations) -> bool:
    """Whether the rotation of X is left open."""
    if seen.kinds == 2 and _turns_by_poses(tool, seen):
        return False
    points = _positions(seen) - _positions(seen).mean(axis=0)
    return np.linalg.svd(points / np.sqrt(len(points)), compute_uv=False)[1] < THIN


def _missed(frames: Frames, tool: np.ndarray, seen: Observations) -> float:
    """The median of what the frames miss [m], with the nominal poses (n, 4, 4) of the tool."""
    predicted = frames.base @ tool @ frames.targets[seen.targets]
    measured = frames.sockets[seen.sockets] if seen.measured is None else seen.measured
    misses = displacements(predicted, measured)
    misses[:, 3:] *= LEVER
    return float(np.median(np.linalg.norm(misses, axis=1)))


def _solutions(tool: np.ndarray, seen: Observations) -> Iterator[Frames]:
    """Frames that fit rows, by nominal poses (n, 4, 4) of the tool; none where they are open."""
    if seen.measured is None:
        yield _by_sockets(tool, seen)
    elif seen.kinds == 2:
        for turn in _turns_by_poses(tool, seen) or _turns_by_positions(tool, seen):
            targets = _targets_turned(turn, tool, seen)
            yield _placed(turn, tool, seen, targets, (UNKNOWN, UNKNOWN))
    else:
        targets = np.tile(np.eye(4), (np.max(seen.targets) + 1, 1, 1))
        for turn in _turns_by_positions(tool, seen):
            yield _placed(turn, tool, seen, targets, (UNKNOWN, (UNKNOWN[0], HELD)))


def _turns_by_poses(tool: np.ndarray, seen: Observations) -> list[np.ndarray]:
    """The rotation (3, 3) of X, from the target that was seen most often; none if it is open."""
    rows = seen.targets == np.bincount(seen.targets).argmax()
    # of X R_i = Y_i Z' in the least squares sense, with the rows of each matrix in one vector
    products = np.einsum("nij,nkl->ikjl", seen.measured[rows, :3, :3], tool[rows, :3, :3])
    left, values, _ = np.linalg.svd(products.reshape(9, 9))
    if values[1] >= UNDECIDED * values[0]:
        return []
    turn = left[:, 0].reshape(3, 3)
    return [nearest_rotation(turn * np.sign(np.linalg.det(turn)))]


def _turns_by_positions(tool: np.ndarray, seen: Observations) -> list[np.ndarray]:
    """Rotations (3, 3) of X from positions: as if z_k were zero, and as if it were any matrix."""
    turns, points, count = tool[:, :3, :3], tool[:, :3, 3], len(seen)
    measured = _positions(seen)
    aligned = (measured - measured.mean(axis=0)).T @ (points - points.mean(axis=0))
    # X' y - R_i z_k + b = t_i
    matrix = np.kron(np.eye(3), measured[:, None]).reshape(count, 3, 9)
    unit = np.tile(np.eye(3), (count, 1, 1))
    system = np.concatenate([matrix, unit, _by_number(-turns, seen.targets)], axis=-1)
    back = _least_squares(system, points)[:9].reshape(3, 3)
    return [nearest_rotation(aligned), nearest_rotation(back).T]


def _positions(seen: Observations) -> np.ndarray:
    """What was measured (n, 3) [m], without orientations."""
    return seen.measured if seen.kinds == 1 else seen.measured[:, :3, 3]


def _targets_turned(turn: np.ndarray, tool: np.ndarray, seen: Observations) -> np.ndarray:
    """Poses (target, 4, 4) without translations, with the rotation of X."""
    between = (turn @ tool[:, :3, :3]).swapaxes(1, 2) @ seen.measured[:, :3, :3]
    targets = np.tile(np.eye(4), (np.max(seen.targets) + 1, 1, 1))
    for number, target in enumerate(targets):
        its = Rotation.from_matrix(between[seen.targets == number])
        target[:3, :3] = its.mean().as_matrix()
    return targets


def _placed(
    turn: np.ndarray,
    tool: np.ndarray,
    seen: Observations,
    targets: np.ndarray,
    deviations: tuple[tuple[float, float], tuple[float, float]],
) -> Frames:
    """The frames with translations, by those of what was measured: y_i - X t_i = x + X R_i z_k."""
    unit = np.tile(np.eye(3), (len(seen), 1, 1))
    system = np.concatenate([unit, _by_number(turn @ tool[:, :3, :3], seen.targets)], axis=-1)
    found = _least_squares(system, _positions(seen) - tool[:, :3, 3] @ turn.T).reshape(-1, 3)
    base, targets = np.eye(4), targets.copy()
    base[:3, :3], base[:3, 3], targets[:, :3, 3] = turn, found[0], found[1:]
    return Frames(base, targets, np.empty((0, 3)), *deviations, unknown=True)


def _by_sockets(tool: np.ndarray, seen: Observations) -> Frames:
    """The frames of balls, and the centres of sockets in the arm's base: c_s - R_i z_k = t_i."""
    unit = np.tile(np.eye(3), (len(seen), 1, 1))
    blocks = _by_number(-tool[:, :3, :3], seen.targets), _by_number(unit, seen.sockets)
    found = _least_squares(np.concatenate(blocks, axis=-1), tool[:, :3, 3]).reshape(-1, 3)
    targets = np.tile(np.eye(4), (np.max(seen.targets) + 1, 1, 1))
    targets[:, :3, 3], sockets = found[: len(targets)], found[len(targets) :]
    return Frames(np.eye(4), targets, sockets, (HELD, HELD), (UNKNOWN[0], HELD), unknown=True)


def _by_number(blocks: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Blocks (n, 3, 3) in rows (n, 3, 3 * numbers) of a matrix, each in the columns it belongs to.

    What is not there has zeros.
    """
    placed = np.zeros((len(blocks), 3, np.max(numbers) + 1, 3))
    placed[np.arange(len(blocks)), :, numbers] = blocks
    return placed.reshape(len(blocks), 3, -1)


def _least_squares(system: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """The smallest solution (m,) of a system (n, 3, m) for a goal (n, 3)."""
    return np.linalg.lstsq(system.reshape(goal.size, -1), goal.ravel(), rcond=OPEN)[0]


def _refined(arm: Arm, frames: Frames, seen: Observations) -> Frames:
    """The frames at a robust optimum nearby, with the nominal arm between them."""
    model = ErrorModel(arm, OFFSETS, frames)
    varied = np.flatnonzero(model.free & (model.deviations > HELD))
    terms, units = model.terms(seen.joints), np.array([1.0, LEVER])[: seen.kinds, None, None]

    def look(numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        parameters = np.zeros_like(model.deviations)
        parameters[varied] = numbers
        near = Linearised(model, parameters, seen, terms)
        slopes = near.jacobians[..., varied] * units[..., None]
        return (near.residuals * units).ravel(), -slopes.reshape(-1, len(varied))

    found = least_squares(
        lambda numbers: look(numbers)[0],
        np.zeros(len(varied)),
        jac=lambda numbers: look(numbers)[1],
        loss="soft_l1",
        f_scale=ROBUST,
        max_nfev=STEPS,
    )
    parameters = np.zeros_like(model.deviations)
    parameters[varied] = found.x * model.deviations[varied]
    return model.found(parameters)
