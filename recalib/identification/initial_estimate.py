"""Initial estimate of the frames of instrument and targets, without a starting value.

Closed forms are solved for all rows and for many small sets of rows: a few gross outliers spoil
only some of the sets. Robust least squares refines the solutions with the smallest median errors.
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

SETS, SPARE = 60, 3  # the number of small sets, and their rows in excess of the minimum
MOST = 200  # rows to estimate from: more add little
REFINED = 6  # the number of best estimates to refine
ROBUST, STEPS = 5e-3, 30  # of a refinement: the scale [m] of gross errors, the most evaluations
FARTHEST = 0.15  # m: an arm with a larger median error is not the described one
THIN = 5e-3  # m: points with a smaller standard deviation across a line count as collinear
# Weak prior, in m or m/rad of residual per unit of a scaled parameter. It holds directions that the
# rows do not determine, such as the height of an arm with parallel axes, at their closed form.
WEAK_PRIOR = 1e-6


class NoInitialEstimate(RecalibError):
    """The frame of the instrument or of a target is not identifiable."""


def fewest(observations: Observations) -> int:
    """The minimum number of rows for an initial estimate."""
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

    Raises NoInitialEstimate: too few rows, too similar postures, or no frames that fit; and
    BadMeasurement: numbers that are not finite, or matrices that are not poses.
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
        rare = np.flatnonzero(~np.isin(group, group[order[:MOST]]))  # all rows of groups left out
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
    """The frames of several instruments and targets, joined from the frames of each sight alone.

    The first sight of an instrument or a target decides. `sights` (s, 2) has the numbers of both.
    """
    instruments, targets = (np.unique(column, return_index=True)[1] for column in sights.T)
    bases = np.array([parts[sight].base for sight in instruments])
    ends = np.array([parts[sight].targets[0] for sight in targets])
    return replace(parts[0], base=bases[0], further=bases[1:], targets=ends, sights=sights)


def _small_sets(observations: Observations, rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Sets of rows that contain each target, or each ball in each socket, about equally often."""
    group = observations.groups
    each = -(-(fewest(observations) + SPARE) // (group.max() + 1))
    for _ in range(SETS):
        order = rng.permutation(len(observations))
        ranks = [np.flatnonzero(group[order] == n)[:each] for n in range(group.max() + 1)]
        yield order[np.concatenate(ranks)]


def _is_open(tool: np.ndarray, observations: Observations, target: np.ndarray | None) -> bool:
    """Whether the rows leave the rotation of the instrument undetermined."""
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
    """The frames at a nearby robust optimum, with the nominal arm between them."""
    model = ErrorModel(arm, OFFSETS, frames)
    varied = np.flatnonzero(model.free & (model.deviations > HELD))
    if not len(varied):
        return frames
    terms = model.terms(observations.joints)
    units = np.array([1.0, LEVER])[: observations.kinds, None, None]
    prior = WEAK_PRIOR * np.eye(len(varied))

    @lru_cache(maxsize=1)  # the optimiser asks for residuals and slopes one after the other
    def linearised(numbers: bytes) -> tuple[np.ndarray, np.ndarray]:
        parameters = np.zeros_like(model.deviations)
        parameters[varied] = np.frombuffer(numbers)
        linearisation = Linearisation(model, parameters, observations, terms)
        slopes = linearisation.jacobians[..., varied] * units[..., None]
        residuals = (linearisation.residuals * units).ravel()
        return (
            np.concatenate([residuals, prior @ parameters[varied]]),
            np.concatenate([-slopes.reshape(-1, len(varied)), prior]),
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
