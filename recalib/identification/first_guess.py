"""A first guess of where the instrument stands and where the targets sit, from anywhere.

Closed forms are solved for all rows and for many small sets of them, which a few gross outliers do
not all spoil. The best, by the median of what they miss, are refined by robust least squares.
"""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from scipy.optimize import least_squares

from recalib.errors import RecalibError
from recalib.identification.closed_forms import solutions, turns_by_poses
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.frames import HELD, Frames
from recalib.identification.linearised import LEVER, Linearised, displacements
from recalib.identification.observations import Observations
from recalib.nominal.kinematics import Arm
from recalib.randomness import generator

SETS, SPARE = 60, 3  # small sets of rows, and how many rows they have beyond the fewest
MOST = 200  # rows to guess from: more tell little more
REFINED = 6  # so many of the best guesses are refined
ROBUST, STEPS = 5e-3, 30  # m that count as gross, and evaluations, of a refinement
FARTHEST = 0.15  # m: an arm that misses by more, in the median, is not the one that is described
THIN = 5e-3  # m: the standard deviation across a line of points that are on it


class NoFirstGuess(RecalibError):
    """Where the instrument stands, or where a target sits, cannot be told from what was seen."""


def fewest(seen: Observations) -> int:
    """How many rows a first guess needs, if each of them is of use."""
    targets = int(np.max(seen.targets, initial=0)) + 1
    if seen.measured is None:
        return targets + int(np.max(seen.sockets, initial=0)) + 2
    return (2 if seen.kinds == 2 else 5) + targets


def guess_frames(
    arm: Arm,
    seen: Observations,
    base: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> Frames:
    """The frames at both ends of the nominal arm, to start an identification from.

    Args:
        base: (4, 4) m in the frame of the instrument, where it is known.
        target: (4, 4) m in the frame of the tool, where it is known, the same for all targets.

    Raises NoFirstGuess: too few rows, postures too much alike, or nothing that explains them.
    """
    if len(seen) < fewest(seen):
        raise NoFirstGuess(
            f"{len(seen)} rows leave open where instrument and target are;"
            f" valid: at least {fewest(seen)}"
        )
    random = generator(0, "first guess")
    if len(seen) > MOST:
        seen = seen[_some(seen, random.permutation(len(seen)))]
    tool = arm.forward(seen.joints)
    if seen.measured is not None and base is None and _is_open(tool, seen, target):
        raise NoFirstGuess(
            "the targets were seen along a line, which leaves open how the instrument is turned"
            " about it; valid: positions that span an area"
            + (", or postures that turn the tool about several axes" if seen.kinds == 2 else "")
        )
    found = [
        frames
        for rows in [np.arange(len(seen)), *_small_sets(seen, random)]
        for frames in solutions(tool[rows], seen[rows], base, target)
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


def _some(seen: Observations, order: np.ndarray) -> np.ndarray:
    """The first rows of an order, and all rows of groups that none of these is of."""
    group = seen.groups
    rare = np.flatnonzero(~np.isin(group, group[order[:MOST]]))
    return np.union1d(order[:MOST], rare)


def _small_sets(seen: Observations, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Rows in which each target, or each socket with each ball, is seen about equally often."""
    group = seen.groups
    each = -(-(fewest(seen) + SPARE) // (group.max() + 1))
    for _ in range(SETS):
        order = random.permutation(len(seen))
        ranks = [np.flatnonzero(group[order] == one)[:each] for one in range(group.max() + 1)]
        yield order[np.concatenate(ranks)]


def _is_open(tool: np.ndarray, seen: Observations, target: np.ndarray | None) -> bool:
    """Whether the rotation of the instrument is left open."""
    if seen.kinds == 2 and (target is not None or turns_by_poses(tool, seen)):
        return False
    points = seen.positions - seen.positions.mean(axis=0)
    return np.linalg.svd(points / np.sqrt(len(points)), compute_uv=False)[1] < THIN


def typical_miss(frames: Frames, arm: Arm, seen: Observations) -> float:
    """The median of what the frames miss [m] with the nominal arm between them."""
    return _missed(frames, arm.forward(seen.joints), seen)


def _missed(frames: Frames, tool: np.ndarray, seen: Observations) -> float:
    """The median of what the frames miss [m], with the nominal poses (n, 4, 4) of the tool."""
    predicted = frames.base @ tool @ frames.targets[seen.targets]
    measured = frames.sockets[seen.sockets] if seen.measured is None else seen.measured
    misses = displacements(predicted, measured)
    misses[:, 3:] *= LEVER
    return float(np.median(np.linalg.norm(misses, axis=1)))


def _refined(arm: Arm, frames: Frames, seen: Observations) -> Frames:
    """The frames at a robust optimum nearby, with the nominal arm between them."""
    model = ErrorModel(arm, OFFSETS, frames)
    varied = np.flatnonzero(model.free & (model.deviations > HELD))
    terms, units = model.terms(seen.joints), np.array([1.0, LEVER])[: seen.kinds, None, None]

    @lru_cache(maxsize=1)  # residuals and slopes are asked for one after the other
    def look(numbers: bytes) -> tuple[np.ndarray, np.ndarray]:
        parameters = np.zeros_like(model.deviations)
        parameters[varied] = np.frombuffer(numbers)
        near = Linearised(model, parameters, seen, terms)
        slopes = near.jacobians[..., varied] * units[..., None]
        return (near.residuals * units).ravel(), -slopes.reshape(-1, len(varied))

    found = least_squares(
        lambda numbers: look(numbers.tobytes())[0],
        np.zeros(len(varied)),
        jac=lambda numbers: look(numbers.tobytes())[1],
        loss="soft_l1",
        f_scale=ROBUST,
        max_nfev=STEPS,
    )
    parameters = np.zeros_like(model.deviations)
    parameters[varied] = found.x * model.deviations[varied]
    return model.found(parameters)
