"""From corners in pictures to a lens, poses, and what the corners say of lens, board and poses.

Near the best poses and lens, the squares of all reprojection errors are a sum of two parts: of what
moves each pose from its best, as sure as its corners make it, and of what moves the lens from its
best with all poses free. So an identification from poses with these weights, in which lens and
board are parameters, too, is one from pixels: its normal equations are the same.
"""

from collections.abc import Sequence

import cv2
import numpy as np

from recalib.identification.model.optics import BOARD, OPTICS, Optics
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens

FEWEST = 6  # pictures, to know a lens by
LENS_SIZE = len(OPTICS) - len(BOARD)  # parameters of a lens
LENS = slice(6, 6 + LENS_SIZE)  # among OpenCV's derivatives, behind those of the pose
FAR = 4.0  # standard deviations: a corner farther out is no part of the board
CONVERGED = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-12)


def find_lens(board: Board, views: Sequence[Corners], size: tuple[int, int]) -> Lens:
    """The lens by the pictures (at least `FEWEST`) of a board anywhere."""
    points = [board.points[view.numbers].astype(np.float32) for view in views]
    pixels = [view.pixels.astype(np.float32) for view in views]
    _, matrix, distortion, _, _ = cv2.calibrateCamera(
        points, pixels, size, None, None, flags=cv2.CALIB_FIX_K3, criteria=CONVERGED
    )
    return Lens(size, matrix, distortion.ravel()[:5])


def board_pose(board: Board, lens: Lens, view: Corners) -> np.ndarray:
    """The pose (4, 4) [m] of the board in the camera: the camera's z axis goes into the picture."""
    points, optics = board.points[view.numbers], (lens.matrix, lens.distortion)
    _, turn, place = cv2.solvePnP(points, view.pixels, *optics, flags=cv2.SOLVEPNP_IPPE)
    turn, place = cv2.solvePnPRefineLM(points, view.pixels, *optics, turn, place, CONVERGED)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = cv2.Rodrigues(turn)[0], place.ravel()
    return pose


def reprojection(board: Board, lens: Lens, view: Corners, pose: np.ndarray) -> np.ndarray:
    """Of each corner, where it is less where it should be (c, 2) [px]."""
    turn, points = cv2.Rodrigues(pose[:3, :3])[0], board.points[view.numbers]
    expected, _ = cv2.projectPoints(points, turn, pose[:3, 3], lens.matrix, lens.distortion)
    return view.pixels - expected.reshape(-1, 2)


def good_corners(board: Board, lens: Lens, view: Corners) -> Corners:
    """Those of a view that are where the others have them."""
    off = np.linalg.norm(reprojection(board, lens, view, board_pose(board, lens, view)), axis=1)
    good = off <= FAR * max(np.median(off), np.finfo(float).eps)
    return Corners(view.numbers[good], view.pixels[good], view.softness)


def optics_of(
    board: Board, lens: Lens, views: Sequence[Corners], fitted: bool, in_hand: bool
) -> tuple[np.ndarray, Optics]:
    """Measured poses (n, 4, 4) [m], and what is known of them.

    Args:
        fitted: whether the lens is that of the views; otherwise it is known.
        in_hand: whether poses are those of the camera in the board; those of the board in the
            camera otherwise.
    """
    count, parts, poses, squares, free = len(OPTICS) if fitted else len(BOARD), [], [], 0.0, 0.0
    for view in views:
        pose = board_pose(board, lens, view)
        residuals = reprojection(board, lens, view, pose).ravel()
        by_pose, by_optics = _derivatives(board.points[view.numbers], lens, pose, in_hand)
        parts.append(_marginal(by_pose, by_optics[:, :count], residuals))
        poses.append(np.linalg.inv(pose) if in_hand else pose)
        squares, free = squares + residuals @ residuals, free + len(residuals) - 6
    variance = squares / (free - LENS_SIZE * fitted)
    spread, slopes, information, gradient, pixels = map(np.array, zip(*parts, strict=True))
    knowledge = information / variance, gradient / variance
    return np.array(poses), Optics(variance * spread, slopes, *knowledge, pixels)


def _marginal(
    by_pose: np.ndarray, by_optics: np.ndarray, residuals: np.ndarray
) -> tuple[np.ndarray, ...]:
    """What corners with a noise of 1 px say, by their derivatives (2 c, 6) and (2 c, o).

    Returns the covariance (6, 6) of the pose, how it makes up for a change of optics (6, o), what
    is known of the optics with the pose free, (o, o) and (o,), and `pixels` (6, 6) of `Optics`.
    """
    root = np.linalg.qr(by_pose).R
    slopes = -np.linalg.lstsq(by_pose, by_optics, rcond=None)[0]
    left = by_optics + by_pose @ slopes
    covariance, pixels = np.linalg.inv(root.T @ root), root * np.sqrt(2 / len(by_pose))
    return covariance, slopes, left.T @ left, left.T @ residuals, pixels


def _derivatives(
    points: np.ndarray, lens: Lens, pose: np.ndarray, in_hand: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Of pixels (2 c, 6) by a displacement of the measured pose, and by optics (2 c, o)."""
    turn, place = cv2.Rodrigues(pose[:3, :3])[0], pose[:3, 3]
    _, slopes = cv2.projectPoints(points, turn, place, lens.matrix, lens.distortion)
    by_place = slopes[:, 3:6].reshape(-1, 2, 3)
    if in_hand:  # displacements of the camera, along the axes of the board
        levers = points + pose[:3, :3].T @ place
        by_place = -by_place @ pose[:3, :3]
    else:
        levers = points @ pose[:3, :3].T
    by_turn = np.cross(levers[:, None], by_place)
    by_pose = np.concatenate([by_place, by_turn], axis=-1).reshape(-1, 6)
    by_point = slopes[:, 3:6].reshape(-1, 2, 3) @ pose[:3, :3]
    by_scale = by_point[..., :2] * points[:, None, :2]
    return by_pose, np.concatenate([by_scale.reshape(-1, 2), slopes[:, LENS]], axis=1)
