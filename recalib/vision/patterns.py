"""Corners of boards that others print: chessboards, asymmetric circles, and Kalibr's tags."""

from typing import Any

import cv2
import numpy as np

from recalib.vision.boards import CHESSBOARD, Board

KALIBR_BORDER = 2  # modules of black around the bits of Kalibr's tags
NEAR = 0.25  # of a tag's side: the window in which its corners are refined
WINDOWS = 2, 8  # px, either way
REFINED = cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 50, 1e-3
NOTHING = np.zeros(0, int), np.zeros((0, 2))


def find_pattern(board: Board, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (c,) and pixels (c, 2) of all corners of a chessboard, or of all circles.

    None unless all of them are found.
    """
    if board.kind == CHESSBOARD:
        return _chessboard(board, picture)
    size, flags = (board.columns, board.rows), cv2.CALIB_CB_ASYMMETRIC_GRID
    for way in (flags, flags | cv2.CALIB_CB_CLUSTERING):
        whole, centres = cv2.findCirclesGrid(picture, size, flags=way)
        if whole:
            return np.arange(board.columns * board.rows), centres.reshape(-1, 2).astype(float)
    return NOTHING


def _chessboard(board: Board, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners from the upper left one, by a square's colour if it says which that is.

    A board with an even number of columns and an odd one of rows, or the other way around, has one
    upper left corner that is dark. Another board looks the same upside down: it counts as upright.
    """
    columns, rows = board.columns - 1, board.rows - 1
    flags = cv2.CALIB_CB_EXHAUSTIVE + cv2.CALIB_CB_ACCURACY + cv2.CALIB_CB_NORMALIZE_IMAGE
    whole, found = cv2.findChessboardCornersSB(picture, (columns, rows), flags=flags)
    if not whole:
        return NOTHING
    grid = found.reshape(rows, columns, 2).astype(float)
    across, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if across[0] * down[1] - across[1] * down[0] < 0:  # x to the right, y down
        grid = grid[::-1]
    if (columns + rows) % 2:
        middles = (grid[:2, at : at + 2].mean(axis=(0, 1)).round().astype(int) for at in (0, 1))
        first, second = (np.median(picture[y - 1 : y + 2, x - 1 : x + 2]) for x, y in middles)
        upside_down = first > second
    else:
        upside_down = grid[0, 0].sum() > grid[-1, -1].sum()
    if upside_down:
        grid = grid[::-1, ::-1]
    return np.arange(columns * rows), grid.reshape(-1, 2)


def tags_of_kalibr(
    board: Board, picture: np.ndarray, settings: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 4, 2) [px], clockwise from the upper left, and numbers (m,) of Kalibr's tags."""
    settings.markerBorderBits = KALIBR_BORDER
    detector = cv2.aruco.ArucoDetector(board.alphabet, settings)
    corners, ids, _ = detector.detectMarkers(picture)
    if ids is None:
        return np.zeros((0, 4, 2)), np.zeros(0, int)
    markers, numbers = np.array(corners).reshape(-1, 4, 2), ids.ravel()
    for tag in markers:
        side = np.linalg.norm(tag - np.roll(tag, 1, axis=0), axis=1).min()
        window = int(np.clip(NEAR * side * (board.square / board.marker - 1) * 2, *WINDOWS))
        tag[:] = cv2.cornerSubPix(
            picture, tag.reshape(4, 1, 2).copy(), (window, window), (-1, -1), REFINED
        )[:, 0]
    known = np.isin(numbers - board.first_id, np.arange(board.markers))
    if not known.all():
        return markers, numbers
    places = board.tags[numbers - board.first_id]
    turned = [np.roll(markers, step, axis=1) for step in range(4)]  # prints differ in how tags lie
    return min(turned, key=lambda each: misplaced(places, each)), numbers


def misplaced(places: np.ndarray, markers: np.ndarray) -> float:
    """How far markers (m, 4, 2) [px] are from where a plane has them, in sides of theirs."""
    plane, _ = cv2.findHomography(places.reshape(-1, 2), markers.reshape(-1, 2), cv2.LMEDS)
    if plane is None:
        return np.inf
    expected = cv2.perspectiveTransform(places.astype(float), plane)
    gaps = np.linalg.norm(expected - markers, axis=-1).mean(axis=1)
    return float(np.quantile(gaps / np.linalg.norm(markers[:, 0] - markers[:, 1], axis=-1), 0.75))
