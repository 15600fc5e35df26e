"""Calibration of a lens from pictures of boards in any pose: its model and its parameters.

The evidence selects the model. The poses of the board are not unknowns of the search: for each
lens, each picture has its best pose. So only the normal equations of the lens remain (variable
projection, Golub and Pereyra 1973). Their step is the distance to the optimum, in deviations.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from recalib.identification.calibration import CONVINCING
from recalib.identification.model.optics import BOARD, OPTICS
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens
from recalib.vision.views import board_pose, optics_kinds, reprojection, sighting

View = tuple[Board, Corners]  # the board in a picture, and its detected corners
FEWEST = 6  # the least number of pictures to calibrate a lens from
# Numbers of distortion coefficients of pinhole models, the simplest first. A fisheye has 4.
PINHOLES = 4, 5, 8
FOCAL_LENGTHS = 0.25, 0.4, 0.6, 0.9, 1.3, 2.0, 3.5  # starting values, over the larger side
STEPS, DAMPING, STIFFEST = 60, 1e-3, 1e9
CONVERGED = 0.01  # standard deviations from the optimum
LEAST_NOISE = 1e-6  # px


@dataclass(frozen=True)
class FoundLens:
    """A lens calibrated from pictures.

    Attributes:
        lens: the lens.
        error: px, the rms reprojection error along an axis, over the degrees of freedom.
        evidence: the log evidence of the model, by Schwarz's criterion, up to a constant.
        converged: whether the search converged.
        deviations: (2,) px, standard deviations of the focal lengths along x and y.
    """

    lens: Lens
    error: float
    evidence: float
    converged: bool
    deviations: np.ndarray


def find_lens(views: Sequence[View], size: tuple[int, int]) -> FoundLens:
    """The lens from pictures (at least `FEWEST`) of boards in any pose.

    A richer model, or a fisheye, is chosen only if it is far more probable than a simpler model. It
    is tried only if the simpler pinhole leaves residuals that a richer model could explain.
    """
    best = last = _best_from(views, _straight(views, size, False))
    for count in PINHOLES[1:]:
        if best.converged and _gain(views, _extended(best.lens, PINHOLES[-1])) < CONVINCING:
            return best
        last = _best_from(views, _extended(last.lens, count))
        best = _more_probable(best, last)
    return _more_probable(best, _best_from(views, _straight(views, size, True)))


def _extended(lens: Lens, count: int) -> Lens:
    """The same lens with `count` distortion coefficients, the new ones zero."""
    return replace(lens, distortion=np.resize([*lens.distortion, *np.zeros(count)], count))


def _more_probable(simpler: FoundLens, richer: FoundLens) -> FoundLens:
    added = len(richer.lens.distortion)
    if simpler.lens.fisheye == richer.lens.fisheye:
        added -= len(simpler.lens.distortion)
    gain = richer.evidence - simpler.evidence
    probable = gain > CONVINCING * np.sqrt(added)
    return richer if probable and richer.converged >= simpler.converged else simpler


class _Normal(NamedTuple):
    """The best poses of the boards for a lens, and the normal equations of the lens there.

    Attributes:
        poses: (4, 4) m, the pose of the board in the camera, for each picture.
        squares: px^2, the sum of squared reprojection errors.
        free: the degrees of freedom that the poses leave.
        information, gradient: (k, k) and (k,), of the parameters of the lens [px, 1].
    """

    poses: list[np.ndarray]
    squares: float
    free: int
    information: np.ndarray
    gradient: np.ndarray

    @property
    def variance(self) -> float:
        """The variance [px^2] of the noise along an axis."""
        return max(self.squares / (self.free - len(self.gradient)), LEAST_NOISE**2)


def _straight(views: Sequence[View], size: tuple[int, int], fisheye: bool) -> Lens:
    """The best of a few lenses with a central principal point and no distortion."""
    some = slice(None, None, max(1, len(views) // FEWEST))
    x, y = (side / 2 - 0.5 for side in size)
    lenses = [
        Lens(size, np.array([[focal, 0, x], [0, focal, y], [0, 0, 1]]), np.zeros(4), fisheye)
        for focal in max(size) * np.array(FOCAL_LENGTHS)
    ]
    return min(lenses, key=lambda lens: _posed(lens, views[some])[0])


def _best_from(views: Sequence[View], lens: Lens) -> FoundLens:
    """The best lens of the same model, by Levenberg-Marquardt steps from a lens nearby."""
    here, damping, converged = _normal(views, lens), DAMPING, False
    for _ in range(STEPS):
        precision = _precision(lens, here)
        full_step = np.linalg.solve(precision, here.gradient)
        if converged := bool(here.gradient @ full_step < CONVERGED**2 * here.variance):
            break
        damped = precision + damping * np.diag(precision.diagonal())
        moved = moved_lens(lens, np.linalg.solve(damped, here.gradient))
        squares, poses = _posed(moved, views, here.poses) if moved else (np.inf, [])
        if moved and squares < here.squares:
            lens, here, damping = moved, _normal(views, moved, poses), damping / 10
        elif damping < STIFFEST:
            damping *= 10
        else:
            break
    squares = max(here.squares, here.free * LEAST_NOISE**2)
    count = len(here.gradient)
    evidence = -here.free / 2 * np.log(squares) - count / 2 * np.log(here.free)
    focal = np.linalg.inv(_precision(lens, here)).diagonal()[:2]
    deviations = np.sqrt(here.variance * focal)
    return FoundLens(lens, float(np.sqrt(here.variance)), float(evidence), converged, deviations)


def _gain(views: Sequence[View], lens: Lens) -> float:
    """The approximate gain in log evidence from this lens to the best lens of its model."""
    here = _normal(views, lens)
    step = np.linalg.solve(_precision(lens, here), here.gradient)
    return float(here.gradient @ step / here.variance - np.log(here.free)) / 2


def _normal(views: Sequence[View], lens: Lens, starts: Sequence[np.ndarray | None] = ()) -> _Normal:
    pairs = zip(views, starts or [None] * len(views), strict=True)
    sightings = [sighting(board, lens, view, True, False, at) for (board, view), at in pairs]
    of_lens = slice(len(BOARD), None)
    return _Normal(
        [one.pose for one in sightings],
        sum(one.squares for one in sightings),
        sum(one.free for one in sightings),
        np.sum([one.information[of_lens, of_lens] for one in sightings], axis=0),
        np.sum([one.gradient[of_lens] for one in sightings], axis=0),
    )


def _precision(lens: Lens, found: _Normal) -> np.ndarray:
    """The information (k, k) on a lens, from the pictures and the prior."""
    prior = np.array([unit * spread for _, _, unit, spread in OPTICS])[optics_kinds(lens)]
    return found.information + np.diag(found.variance / prior**2)


def reprojection_error(views: Sequence[View], lens: Lens) -> float:
    """The rms reprojection error [px], as `FoundLens.error`; infinite if it cannot see corners."""
    free = sum(2 * len(view.numbers) - 6 for _, view in views)
    return float(np.sqrt(_posed(lens, views)[0] / free))


def _posed(
    lens: Lens, views: Sequence[View], starts: Sequence[np.ndarray | None] = ()
) -> tuple[float, list[np.ndarray]]:
    """The sum [px^2] of squared reprojection errors, infinite if a lens cannot see the corners.

    With the best pose (4, 4) [m] of the board in each view.
    """
    total, poses = 0.0, []
    for (board, view), start in zip(views, starts or [None] * len(views), strict=True):
        poses.append(board_pose(board, lens, view, start))
        if not np.isfinite(poses[-1]).all():
            return np.inf, poses
        total += float(np.sum(reprojection(board, lens, view, poses[-1]) ** 2))
    return total, poses


def moved_lens(lens: Lens, step: np.ndarray) -> Lens | None:
    """The lens after a step of its parameters (k,); None if a focal length is not positive."""
    fx, fy, cx, cy, *distortion = step
    matrix = lens.matrix + np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 0]])
    if min(matrix[0, 0], matrix[1, 1]) <= 0:
        return None
    return replace(lens, matrix=matrix, distortion=lens.distortion + distortion)
