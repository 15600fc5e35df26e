"""Poses from corners in pictures, and the corners' information on poses, lens and board.

Near the best poses and lens, the sum of squared reprojection errors has two parts: one in the
displacement of each pose from its best, weighted by the information of its corners; and one in the
displacement of the lens from its best, with all poses free. So an identification from poses with
these weights, in which lens and board are parameters, too, has the normal equations of one from
pixels.
"""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from recalib.identification.model.linearisation import crosses
from recalib.identification.model.optics import BOARD, Optics
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens

FAR = 4.0  # medians of the reprojection error: corners farther off are false detections
NARROW = 12.0  # px, the shorter side of a marker: if it is less, hardly half of them are found
STEPS, SMALL = 30, 1e-9  # of a search for a pose; the step [m, rad] at which it has converged
STRAIGHT = 4  # parameters of a lens without distortion: focal lengths and principal point
RADIAL = [0, 1, 4, 5]  # OpenCV's pinhole coefficients that correspond to those of a fisheye


def optics_kinds(lens: Lens) -> np.ndarray:
    """The index (k,) in `OPTICS` of each parameter of a lens, from the focal lengths on."""
    count = len(lens.distortion)
    coefficients = RADIAL if lens.fisheye else [*range(count)]
    return len(BOARD) + np.array([*range(STRAIGHT), *(STRAIGHT + n for n in coefficients)])


def board_pose(
    board: Board, lens: Lens, view: Corners, start: np.ndarray | None = None
) -> np.ndarray:
    """The pose (4, 4) [m] of the board in the camera, whose z axis points into the picture.

    It minimises the squared reprojection errors. If the lens cannot see the corners, it is NaN. A
    start nearby saves time.
    """
    points, pixels = board.points[view.numbers], view.pixels
    found = _first_pose(points, lens, pixels) if start is None else _vector(start)
    expected, slopes = _project(points, lens, found)
    residuals = (pixels - expected).ravel()
    for _ in range(STEPS):
        by_pose = slopes[:, :6]
        information = by_pose.T @ by_pose
        if not np.isfinite(information).all():
            return np.full((4, 4), np.nan)
        step = np.linalg.lstsq(information, by_pose.T @ residuals, rcond=None)[0]
        moved = found + step
        expected, slopes_there = _project(points, lens, moved)
        there = (pixels - expected).ravel()
        if not there @ there < residuals @ residuals:
            break
        found, residuals, slopes = moved, there, slopes_there
        if np.abs(step).max() < SMALL:
            break
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = cv2.Rodrigues(found[:3])[0], found[3:]
    return pose


def _first_pose(points: np.ndarray, lens: Lens, pixels: np.ndarray) -> np.ndarray:
    """An approximate pose of the board, as in `_vector`, from the directions of the pixels."""
    module = cv2.fisheye if lens.fisheye else cv2
    rays = module.undistortPoints(pixels[:, None], lens.matrix, lens.distortion)
    _, turn, place = cv2.solvePnP(points, rays, np.eye(3), None, flags=cv2.SOLVEPNP_IPPE)
    return np.concatenate([turn, place]).ravel()


def _vector(pose: np.ndarray) -> np.ndarray:
    """A pose (4, 4) as OpenCV's parameters (6,): the vector of its rotation, and its position."""
    return np.concatenate([cv2.Rodrigues(pose[:3, :3])[0].ravel(), pose[:3, 3]])


def reprojection(board: Board, lens: Lens, view: Corners, pose: np.ndarray) -> np.ndarray:
    """The reprojection errors (c, 2) [px] of the corners, observed minus expected."""
    expected, _ = projected(board.points[view.numbers], lens, pose)
    return view.pixels - expected


def good_corners(board: Board, lens: Lens, view: Corners) -> Corners:
    """The corners of a view that fit the pose of the board."""
    off = np.linalg.norm(reprojection(board, lens, view, board_pose(board, lens, view)), axis=1)
    good = off <= FAR * max(np.median(off), np.finfo(float).eps)
    return Corners(view.numbers[good], view.pixels[good], view.softness)


class Sighting(NamedTuple):
    """A pose and the information from its picture, for corners with a noise of 1 px; see `Optics`.

    Attributes:
        pose: (4, 4) m, of the camera in the board if the camera is on the hand; otherwise of the
            board in the camera.
        squares: px^2, the sum of squared reprojection errors.
        free: the degrees of freedom that the pose leaves.
    """

    pose: np.ndarray
    spread: np.ndarray
    slopes: np.ndarray
    information: np.ndarray
    gradient: np.ndarray
    pixels: np.ndarray
    squares: float
    free: int


def sighting(
    board: Board,
    lens: Lens,
    view: Corners,
    fitted: bool,
    in_hand: bool,
    start: np.ndarray | None = None,
) -> Sighting:
    """The pose from a view, with the view's information on the optics.

    Args:
        fitted: whether the lens is estimated, too; otherwise it is known.
        in_hand: whether the camera is on the hand.
        start: a nearby pose of the board in the camera, for speed.
    """
    pose, points = board_pose(board, lens, view, start), board.points[view.numbers]
    expected, slopes = projected(points, lens, pose)
    residuals = (view.pixels - expected).ravel()
    by_pose, by_optics = _derivatives(points, slopes, pose, in_hand)
    if not fitted:
        by_optics = by_optics[:, : len(BOARD)]
    root = np.linalg.qr(by_pose).R
    compensation = _compensation(by_pose, by_optics)
    remaining = by_optics + by_pose @ compensation
    return Sighting(
        np.linalg.inv(pose) if in_hand else pose,
        np.linalg.inv(root.T @ root),
        compensation,
        remaining.T @ remaining,
        remaining.T @ residuals,
        root * np.sqrt(2 / len(by_pose)),
        float(residuals @ residuals),
        len(residuals) - 6,
    )


def predicted_views(
    board: Board, lens: Lens, poses: np.ndarray, in_hand: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Predictions for pictures from which poses (n, 4, 4) [m] would be measured.

    Returns the slopes (n, 6, o) of `Optics`, zero if the board would not be found, and whether most
    of its corners would be found (n,). Arguments are those of `sighting`.
    """
    count = len(BOARD) + len(optics_kinds(lens))
    slopes, visible = np.zeros((len(poses), 6, count)), np.zeros(len(poses), dtype=bool)
    for number, pose in enumerate(np.linalg.inv(poses) if in_hand else poses):
        pixels, by_all = projected(board.points, lens, pose)
        found = _found(board, lens, pose, pixels, by_all)
        if found.mean() > 0.5:
            by_all = by_all[np.repeat(found, 2)]
            derivatives = _derivatives(board.points[found], by_all, pose, in_hand)
            slopes[number], visible[number] = _compensation(*derivatives), True
    return slopes, visible


def optics_of(lens: Lens, sightings: Sequence[Sighting]) -> tuple[np.ndarray, Optics]:
    """The measured poses (n, 4, 4) [m] of sightings through a lens, and their information."""
    poses, *parts, squares, free = map(np.array, zip(*sightings, strict=True))
    spread, slopes, information, gradient, pixels = parts
    kinds = np.concatenate([np.arange(len(BOARD)), optics_kinds(lens)])[: slopes.shape[-1]]
    variance = squares.sum() / (free.sum() - (len(kinds) - len(BOARD)))
    knowledge = information / variance, gradient / variance
    return poses, Optics(variance * spread, slopes, *knowledge, pixels, kinds=kinds)


def _compensation(by_pose: np.ndarray, by_optics: np.ndarray) -> np.ndarray:
    """The displacements (6, o) that compensate for optics, from slopes (2 c, 6) and (2 c, o)."""
    return -np.linalg.lstsq(by_pose, by_optics, rcond=None)[0]


def projected(points: np.ndarray, lens: Lens, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (c, 2) of points (c, 3) [m] of a board at a pose, and their derivatives (2 c, 6 + k).

    The derivatives are by the pose, in OpenCV's parameters, and by the parameters of the lens.
    """
    return _project(points, lens, _vector(pose))


def _project(points: np.ndarray, lens: Lens, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same for a pose as in `_vector`."""
    turn, place = pose[:3], pose[3:]
    if lens.fisheye:
        args = points[:, None], turn, place, lens.matrix, lens.distortion
        pixels, slopes = cv2.fisheye.projectPoints(*args)
        slopes = np.concatenate([slopes[:, 8:14], slopes[:, :8]], axis=1)
    else:
        pixels, slopes = cv2.projectPoints(points, turn, place, lens.matrix, lens.distortion)
    return pixels.reshape(-1, 2), slopes


def _found(
    board: Board, lens: Lens, pose: np.ndarray, pixels: np.ndarray, slopes: np.ndarray
) -> np.ndarray:
    """Whether each corner (c,) of a board at a pose (4, 4) would be found at its projection."""
    turn = pose[:3, :3]
    ahead = board.points @ turn[2] + pose[2, 3] > 0
    inside = ((pixels > 0) & (pixels < np.array(lens.size) - 1)).all(axis=1)
    across = (slopes[:, 3:6].reshape(-1, 2, 3) @ turn)[..., :2]  # px per m on the board
    narrow = (board.marker or board.square) * np.linalg.norm(across, -2, axis=(1, 2))
    faces = np.linalg.det(across) > 0
    return ahead & inside & faces & (narrow > NARROW)


def _derivatives(
    points: np.ndarray, slopes: np.ndarray, pose: np.ndarray, in_hand: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of pixels by displacements of the measured pose (2 c, 6), by optics (2 c, o).

    Points and slopes are as in `projected`; the pose is that of the board in the camera.
    """
    by_place = slopes[:, 3:6].reshape(-1, 2, 3)
    if in_hand:  # displacements of the camera, along the axes of the board
        levers = points + pose[:3, :3].T @ pose[:3, 3]
        by_place = -by_place @ pose[:3, :3]
    else:
        levers = points @ pose[:3, :3].T
    by_turn = by_place @ crosses(-levers)
    by_pose = np.concatenate([by_place, by_turn], axis=-1).reshape(-1, 6)
    by_point = slopes[:, 3:6].reshape(-1, 2, 3) @ pose[:3, :3]
    by_scale = by_point[..., :2] * points[:, None, :2]
    return by_pose, np.concatenate([by_scale.reshape(-1, 2), slopes[:, 6:]], axis=1)
