"""Checks of nominal positions against the nominal kinematics, before the fit.

The tool positions that a controller reports reveal the most frequent mistakes in data: a wrong
zero, sign or order of joints, a wrong unit, a rotated base, a forgotten tool. Mistakes are tried
one at a time, then in pairs; messages name the one that explains the difference.
"""

from itertools import combinations

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import RecalibError
from recalib.identification.calibration import Calibration
from recalib.identification.closed_forms import solutions
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import LEVER, displacements
from recalib.identification.model.observations import Observations
from recalib.laboratory.plausibility.steps import Step, rare_steps_of, steps_of, steps_of_rotations
from recalib.nominal.kinematics import Arm
from recalib.spelling import listed

ALIKE = 0.01  # m: nominal positions that differ by less belong to the same arm
EXPLAINED = 0.2  # the fraction of a difference that may remain once a mistake is corrected
SAME = 1e-6  # if these fractions differ by less, two mistakes explain the data equally well
FEWEST = 3  # outliers that a mistake must explain
ENOUGH = 40  # rows on which mistakes are tried
UNTURNED, MOVED = np.radians(1), 1e-3  # rad, m: smaller rotations and shifts are not reported


class Mistaken(RecalibError):
    """Measurements or their description are likely wrong, or do not determine a pose."""


def check_nominal(
    arm: Arm,
    coordinates: np.ndarray,
    nominal: np.ndarray,
    base: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> str | None:
    """The base or target, in words, that explains how nominal positions differ from the URDF.

    None if they do not differ. An unknown base or target is no mistake: it will be identified.

    Args:
        coordinates: (n, joints) rad, or m where a joint slides.
        nominal: (n, 3) m.
        base: (4, 4) m, the arm's base in the frame of the positions, if known.
        target: (4, 4) m in the tool link's frame, if known.

    Raises Mistaken if anything else makes them differ.
    """
    known = np.eye(4) if base is None else base
    place = np.eye(4) if target is None else target
    gaps = _gaps(arm.forward(coordinates), nominal, known, place)
    if gaps.max() <= ALIKE:
        return None
    rows = np.unique(np.linspace(0, len(nominal) - 1, ENOUGH).astype(int))
    poses, positions = arm.forward(coordinates[rows]), nominal[rows]
    frames, remaining = _fit(poses, positions, base, target)
    if remaining.max() <= ALIKE:
        return _words(frames.base, frames.targets[0, :3, 3])
    frames, remaining = _fit(poses, positions)
    if remaining.max() <= ALIKE:
        point = frames.targets[0, :3, 3] - place[:3, 3]
        words = _words(frames.base @ np.linalg.inv(known), point)
        reason = f"likely: {words}, missing in the description"
    elif mistake := likely_mistake(arm, coordinates, nominal):
        reason = f"likely: {mistake}"
    else:
        reason = "no single mistake of zero, sign, order or unit explains it: is it another arm?"
    raise Mistaken(
        f"nominal positions are up to {1e3 * gaps.max():.1f} mm from where the URDF's kinematics"
        f" put the tool; {reason}"
    )


def likely_mistake(
    arm: Arm,
    coordinates: np.ndarray,
    measured: np.ndarray,
    alike: float = ALIKE,
    most_steps: int = 2,
    frames: Frames | None = None,
) -> str | None:
    """The mistake in data that explains most of a difference, in words; None if none does.

    Single steps are tried first, then pairs. Remaining errors count relative to the spread of the
    positions: data that a step shrinks to a point would fit any arm.

    Args:
        coordinates: (n, joints) rad, or m where a joint slides.
        measured: (n, 3) m, positions of a point on the tool, in any frame; or poses (n, 4, 4).
        alike: m, error that may remain; rotations count as lengths by `LEVER`.
        most_steps: the largest number of simultaneous mistakes.
        frames: explain the data without a mistake, if given; closed forms may miss such frames if
            few joints moved.
    """
    rows = np.unique(np.linspace(1, len(measured) - 2, ENOUGH).astype(int))  # all with neighbours
    poses = arm.forward(coordinates[rows])
    plain = _rms(_fit(poses, measured[rows])[1])
    if frames is not None:
        plain = min(plain, _rms(_gaps(poses, measured[rows], frames.base, frames.targets[0])))
    if plain <= MOVED:  # many mistakes would explain the rounding of a perfect arm
        return None
    steps = [*steps_of(arm), *(steps_of_rotations() if measured.ndim == 3 else ())]
    moved = np.ptp(coordinates, axis=0) > 0
    for count in range(1, most_steps + 1):
        fits = []
        for chosen in combinations(steps if count > 1 else [*steps, *rare_steps_of(arm)], count):
            joints, righted = coordinates, measured
            for step in chosen:
                joints, righted = step.joints(joints), step.measured(righted)
            changed = (joints != coordinates).any(axis=0)
            if frames is not None and changed.any() and not moved[changed].any():
                continue  # where joints stood still, the arm's own errors look like mistakes
            _, gaps = _fit(arm.forward(joints[rows]), righted[rows])
            positions = righted[rows] if righted.ndim == 2 else righted[rows, :3, 3]
            spread = _rms(np.linalg.norm(positions - positions.mean(axis=0), axis=1))
            words = " and ".join(step.words for step in chosen)
            part = _rms(gaps) / spread if spread > 0 else np.inf
            fits.append((part, _rms(gaps), gaps.max(), words))
        part, rms, largest, _ = min(fits)
        if largest <= alike and part < EXPLAINED and rms < EXPLAINED * plain:
            # equally good: a joint's sign, or half a turn of the next one, if the base may turn
            return listed([words for other, *_, words in fits if other <= part + SAME], "or")
    return None


def mistake_of_outliers(geometry: Calibration, observations: Observations) -> str | None:
    """The mistake that likely explains the outliers, as a clause; None if none does."""
    rows = np.flatnonzero(geometry.estimate.weights < DOUBTFUL)
    if observations.measured is None or len(rows) < FEWEST:
        return None
    joints, measured = observations.joints[rows], observations.measured[rows]
    turned = steps_of_rotations() if measured.ndim == 3 else ()
    arm, fits = geometry.model.nominal, []
    for step in (Step(""), *steps_of(arm), *rare_steps_of(arm), *turned):
        if step.of_neighbours:
            continue
        poses = geometry.predict(step.joints(joints), observations.targets[rows])
        fits.append((_gaps(poses, step.measured(measured), np.eye(4), np.eye(4)), step.words))
    gaps, words = min(fits, key=lambda fit: np.median(fit[0]))
    wrong = rows[gaps < np.minimum(ALIKE, EXPLAINED * fits[0][0])] + 1
    if len(wrong) < max(FEWEST, len(rows) / 2):
        return None
    some = f"{len(wrong)} rows, from {wrong[0]} to {wrong[-1]},"
    return f"{some} probably contain a mistake, without which they fit the others: {words}"


def _gaps(
    poses: np.ndarray, nominal: np.ndarray, base: np.ndarray, target: np.ndarray
) -> np.ndarray:
    """Distances (n,) [m] of nominal positions or poses from the target, by both frames (4, 4)."""
    residuals = displacements(base @ poses @ target, nominal)
    residuals[:, 3:] *= LEVER
    return np.linalg.norm(residuals, axis=1)


def _rms(gaps: np.ndarray) -> float:
    return float(np.sqrt(np.mean(gaps**2)))


def _fit(
    poses: np.ndarray,
    nominal: np.ndarray,
    base: np.ndarray | None = None,
    target: np.ndarray | None = None,
) -> tuple[Frames, np.ndarray]:
    """The frames, with those given, that explain positions or poses best, and gaps (n,) [m]."""
    rows = Observations(np.empty((len(nominal), 0)), nominal)
    fits = [
        (frames, _gaps(poses, nominal, frames.base, frames.targets[0]))
        for frames in solutions(poses, rows, base, target)
    ]
    return min(fits, key=lambda fit: _rms(fit[1]))


def _words(base: np.ndarray, point: np.ndarray) -> str:
    """The pose (4, 4) of the base and the point (3,) on the tool [m] in words; zeros left out."""
    turn, words = Rotation.from_matrix(base[:3, :3]), []
    if turn.magnitude() > UNTURNED:
        axis = turn.as_rotvec() / turn.magnitude()
        about = ", ".join(f"{round(number, 2) + 0.0:g}" for number in axis)
        words.append(f"the base turned by {np.degrees(turn.magnitude()):.1f} deg about ({about})")
    if np.linalg.norm(base[:3, 3]) > MOVED:
        words.append(f"the base moved by {_millimetres(base[:3, 3])}")
    if np.linalg.norm(point) > MOVED:
        words.append(f"a tool point at {_millimetres(point)} of the tool link")
    return " and ".join(words)


def _millimetres(vector: np.ndarray) -> str:
    return f"({', '.join(f'{round(1e3 * number, 1) + 0.0:g}' for number in vector)}) mm"
