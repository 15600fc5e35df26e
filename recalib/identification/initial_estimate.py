"""Initial estimate of the frames of instrument and targets, without a starting value.

Closed forms are solved for all rows and for many small sets of them, of which a few gross outliers
spoil only some. The best, by their median error, are refined by robust least squares.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.optimize import least_squares

from recalib.errors import RecalibError, check_kind
from recalib.identification.closed_forms import solutions, turns_by_poses
from recalib.identification.model.error_model import OFFSETS, ErrorModel
from recalib.identification.model.frames import HELD, Frames
from recalib.identification.model.linearisation import LEVER, Linearisation, displacements
from recalib.identification.model.observations import Observations, check_rows
from recalib.nominal.kinematics import Arm
from recalib.numerics.randomness import generator
from recalib.spelling import counted

SETS, SPARE = 60, 3  # small sets of rows, and how many rows they have beyond the fewest
MOST = 200  # rows to estimate from: more add little
REFINED = 6  # so many of the best estimates are refined
ROBUST, STEPS = 5e-3, 30  # m that count as gross, and evaluations, of a refinement
FARTHEST = 0.15  # m: an arm with a larger median error is not the one that is described
THIN = 5e-3  # m: the standard deviation across a line of points that are on it
# m or m/rad of residual by a parameter over its deviation: what rows leave open, such as how high
# an arm with parallel axes stands, stays as in closed form, and rounding does not move it
KEPT = 1e-6


class NoInitialEstimate(RecalibError):
    """The frame of the instrument or of a target is not identifiable."""


def fewest(observations: Observations) -> int:
    """The least number of rows for an initial estimate."""
    targets = int(np.max(observations.targets, initial=0)) + 1
    if observations.sockets is not None:
        return targets + int(np.max(observations.sockets, initial=0)) + 2
    return (2 if observations.kinds == 2 else 5) + targets


def initial_frames(
    arm: Arm,
    observations: Observations,
    base: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> Frames:
    """Initial estimates of the frames at both ends of the nominal arm.

    Args:
        base: (4, 4) m in the frame of the instrument, if known.
        target: (4, 4) m in the frame of the tool, if known, the same for all targets.

    Raises NoInitialEstimate: too few rows, postures too much alike, or nothing that explains them;
    and BadMeasurement: no numbers, or matrices that are not poses.
    """
    check_kind("arm", arm, Arm)
    check_kind("observations", observations, Observations)
    if len(observations) < fewest(observations):
        raise NoInitialEstimate(
            "instrument and target cannot be located from"
            f" {counted(len(observations), 'row')}; expected: at least {fewest(observations)}"
        )
    check_rows(observations)
    rng = generator(0, "first guess")
    if len(observations) > MOST:
        group, order = observations.groups, rng.permutation(len(observations))
        rare = np.flatnonzero(~np.isin(group, group[order[:MOST]]))  # all rows of other groups
        observations = observations[np.union1d(order[:MOST], rare)]
    tool = arm.forward(observations.joints)
    if observations.measured is not None and base is None and _is_open(tool, observations, target):
        raise NoInitialEstimate(
            "the targets lie along a line, so the instrument's rotation about this line is not"
            " identifiable; try: positions that span an area"
            + ", or postures that turn the tool about several axes"
            * (observations.kinds == 2)
        )
    found = [
        frames
        for rows in [np.arange(len(observations)), *_small_sets(observations, rng)]
        for frames in solutions(tool[rows], observations[rows], base, target)
    ]
    found.sort(key=lambda frames: median_error(frames, tool, observations))
    refined = [_refined(arm, frames, observations) for frames in found[:REFINED]]
    best = min(refined, key=lambda frames: median_error(frames, tool, observations))
    error = median_error(best, tool, observations)
    if not error <= FARTHEST:
        raise NoInitialEstimate(
            "no pose of instrument and target fits the measurements: the smallest error is"
            f" {1e3 * error:.0f} mm; expected: up to {1e3 * FARTHEST:.0f} mm, with the arm's"
            " joints, signs, zeros and units"
        )
    return best


def joined_frames(parts: Sequence[Frames], sights: np.ndarray) -> Frames:
    """The frames of several instruments and targets, from the part that each sight alone gives.

    The first part with an instrument or a target decides. Sights (s, 2) are the numbers of both.
    """
    instruments, targets = (np.unique(column, return_index=True)[1] for column in sights.T)
    bases = np.array([parts[sight].base for sight in instruments])
    ends = np.array([parts[sight].targets[0] for sight in targets])
    return replace(parts[0], base=bases[0], further=bases[1:], targets=ends, sights=sights)


def _small_sets(observations: Observations, rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Rows in which each target, or each socket with each ball, is about equally often."""
    group = observations.groups
    each = -(-(fewest(observations) + SPARE) // (group.max() + 1))
    for _ in range(SETS):
        order = rng.permutation(len(observations))
        ranks = [np.flatnonzero(group[order] == one)[:each] for one in range(group.max() + 1)]
        yield order[np.concatenate(ranks)]


def _is_open(tool: np.ndarray, observations: Observations, target: np.ndarray | None) -> bool:
    """Whether the rotation of the instrument is left open."""
    if observations.kinds == 2 and (target is not None or turns_by_poses(tool, observations)):
        return False
    points = observations.positions - observations.positions.mean(axis=0)
    return bool(np.linalg.svd(points / np.sqrt(len(points)), compute_uv=False)[1] < THIN)


def median_error(frames: Frames, tool: np.ndarray, observations: Observations) -> float:
    """The median error [m] with these frames and the nominal poses (n, 4, 4) of the tool."""
    instruments, targets = frames.sights[observations.targets].T
    predicted = frames.bases[instruments] @ tool @ frames.targets[targets]
    residuals = displacements(predicted, observations.reached(frames.sockets))
    residuals[:, 3:] *= LEVER
    return float(np.median(np.linalg.norm(residuals, axis=1)))


def _refined(arm: Arm, frames: Frames, observations: Observations) -> Frames:
    """The frames at a robust optimum nearby, with the nominal arm between them."""
    model = ErrorModel(arm, OFFSETS, frames)
    varied = np.flatnonzero(model.free & (model.deviations > HELD))
    if not len(varied):
        return frames
    terms = model.terms(observations.joints)
    units = np.array([1.0, LEVER])[: observations.kinds, None, None]
    kept = KEPT * np.eye(len(varied))

    @lru_cache(maxsize=1)  # residuals and slopes are asked for one after the other
    def linearised(numbers: bytes) -> tuple[np.ndarray, np.ndarray]:
        parameters = np.zeros_like(model.deviations)
        parameters[varied] = np.frombuffer(numbers)
        linearisation = Linearisation(model, parameters, observations, terms)
        slopes = linearisation.jacobians[..., varied] * units[..., None]
        residuals = (linearisation.residuals * units).ravel()
        return (
            np.concatenate([residuals, kept @ parameters[varied]]),
            np.concatenate([-slopes.reshape(-1, len(varied)), kept]),
        )

    found = least_squares(
        lambda numbers: linearised(numbers.tobytes())[0],
        np.zeros(len(varied)),
        jac=lambda numbers: linearised(numbers.tobytes())[1],
        loss="soft_l1",
        f_scale=ROBUST,
        max_nfev=STEPS,
    )
    parameters = np.zeros_like(model.deviations)
    parameters[varied] = found.x * model.deviations[varied]
    return model.found(parameters)
