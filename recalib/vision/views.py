"""From corners in pictures to a lens, poses, and what the corners say of lens, board and poses.

Near the best poses and lens, the squares of all reprojection errors are a sum of two parts: of what
moves each pose from its best, as sure as its corners make it, and of what moves the lens from its
best with all poses free. So an identification from poses with these weights, in which lens and
board are parameters, too, is one from pixels: its normal equations are the same.
"""

from collections.abc import Sequence

import cv2
import numpy as np

from recalib.identification.optics import BOARD, OPTICS, Optics
from recalib.vision.boards import Board
from recalib.vision.detection import Corners
from recalib.vision.lenses import Lens

FEWEST = 6  # pictures, to know a lens by
POSE, LENS = slice(0, 6), slice(6, 14)  # of OpenCV's derivatives: a lens without k3
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
    poses, blocks, squares, free = [], [], 0.0, -8.0 * fitted
    for view in views:
        pose = board_pose(board, lens, view)
        residuals = reprojection(board, lens, view, pose)
        squares, free = squares + np.sum(residuals**2), free + residuals.size - 6
        blocks.append(_derivatives(board.points[view.numbers], lens, pose, in_hand))
        poses.append(np.linalg.inv(pose) if in_hand else pose)
    noise, count = float(np.sqrt(squares / free)), len(OPTICS) if fitted else len(BOARD)
    roots, slopes, information = [], [], []
    for by_pose, by_optics in blocks:
        by_optics = by_optics[:, :count]
        back = np.linalg.pinv(by_pose)
        slopes.append(-back @ by_optics)  # the pose that makes up for a change of optics
        left = by_optics + by_pose @ slopes[-1]
        information.append(left.T @ left / noise**2)
        roots.append(np.linalg.qr(by_pose / np.sqrt(len(by_pose) / 2)).R)
    spread = [
        np.linalg.inv(root.T @ root) * 2 / len(by_pose)
        for root, (by_pose, _) in zip(roots, blocks, strict=True)
    ]
    optics = Optics.of(
        noise**2 * np.array(spread),
        np.array(slopes),
        np.array(information),
        np.array(roots),
    )
    return np.array(poses), optics


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
