"""Detection of a board's corners in a picture, or the reason why the picture is unusable."""

import warnings
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from PIL import Image

from recalib.errors import RecalibError
from recalib.vision.boards import APRILGRID, CHARUCO, CHESSBOARD, FEWEST, PLAIN, Board

FEWEST_MARKERS = 4
MISPLACED = 0.3  # of a marker's side: larger deviations from a plane mean another board
OTHERS = "4X4_250", "5X5_250", "6X6_250", "APRILTAG_36H11"
DRAWN = 64  # px, the side of a square in a drawing
HALF = 0.5  # px: this refinement's origin is the picture's corner, not the first pixel's centre
MANY = 3  # markers of another dictionary: more are not false detections
AROUND = 15  # px, the window around an edge for its darkest, brightest and steepest pixels
BLURRED = 0.75  # quantile of the edges' widths: motion blur leaves edges along it sharp
CLEAR = 0.7  # the least contrast of an edge, relative to the highest in the picture
SMOOTHED = 1.0  # px, against noise
SOFT = 1.3  # px: blur that may be the reason why nothing is found
SMALLEST, LARGEST = 32, 100_000_000  # px: the least side, the most pixels in all
KALIBR_BORDER = 2  # black modules around the bits of Kalibr's tags
NEAR = 0.25  # of a tag's side: the window in which its corners are refined
WINDOWS = 2, 8  # px: limits on half the width of this window
REFINED = cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 50, 1e-3


class Unusable(RecalibError):
    """A picture in which the board was not found properly."""


@dataclass(frozen=True)
class Corners:
    """Corners in a picture.

    Attributes:
        numbers: (c,) the indices of the corners among the board's points.
        pixels: (c, 2) px to the right and down, from the centre of the upper left pixel.
        softness: px, the standard deviation of the blur along edges.
    """

    numbers: np.ndarray
    pixels: np.ndarray
    softness: float


def read_picture(path: Path) -> np.ndarray:
    """A file's grey picture (height, width), in the sensor's orientation. Raises Unusable.

    Phones record in their files how they were held, and viewers rotate the pictures accordingly.
    The lens does not rotate with them.
    """
    try:
        if not path.is_file():
            raise Unusable("there is no such file")
        with warnings.catch_warnings(action="ignore"), Image.open(path) as image:  # the header only
            width, height = image.size
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        large = isinstance(error, Image.DecompressionBombError)
        raise Unusable("it is too large" if large else "it is not a picture") from None
    if min(width, height) < SMALLEST or width * height > LARGEST:
        valid = f"at least {SMALLEST} x {SMALLEST}, and at most {LARGEST / 1e6:.0f} million in all"
        raise Unusable(f"it has {width} x {height} pixels; expected: {valid}")
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)
    if picture is None:
        raise Unusable("it is not a picture")
    return picture


def find_corners(board: Board, picture: np.ndarray) -> Corners:
    """The corners of a board in a grey picture (height, width). Raises Unusable."""
    if board.kind in PLAIN:
        numbers, pixels = _pattern(board, picture)
        if not len(numbers):
            squares = replace(board, columns=board.columns + 1, rows=board.rows + 1)
            if board.kind == CHESSBOARD and len(_chessboard(squares, picture)[0]):
                found = f"it shows {squares.columns} x {squares.rows} squares"
                raise Unusable(f"{found}; columns and rows count squares, not corners")
            what = "corners of the chessboard" if board.kind == CHESSBOARD else "circles"
            blur = _softness(picture)
            why = f"; it is blurred, by {blur:.1f} px or more" if blur > SOFT else ""
            raise Unusable(f"it does not show all {len(board.points)} {what}{why}")
    elif board.kind == CHARUCO:
        layouts = [board.drawn, replace(board).drawn]  # OpenCV's current one, and that before 4.6
        layouts[1].setLegacyPattern(True)
        numbers, pixels, problem = min(
            (_charuco(board, layout, picture) for layout in layouts[: 2 - board.rows % 2]),
            key=lambda found: (bool(found[2]), -len(found[0])),
        )
        if problem:
            raise Unusable(_mistake(board, picture) or problem)
    else:
        markers, ids = _markers(board, picture, exact=True)
        if problem := _problem(board, board.tags, markers, ids):
            raise Unusable(_mistake(board, picture) or problem)
        numbers = (4 * (ids - board.first_id)[:, None] + np.arange(4)).ravel()
        pixels = markers.reshape(-1, 2)
    if len(numbers) < FEWEST:
        raise Unusable(f"it shows {len(numbers)} corners; expected: at least {FEWEST}")
    if are_on_a_line(board, numbers):
        raise Unusable("its corners lie on a line; expected: corners that span an area")
    pixels = pixels.astype(float)
    (left, top), (right, bottom) = pixels.min(axis=0).astype(int), pixels.max(axis=0).astype(int)
    top, left = max(0, top), max(0, left)
    return Corners(numbers, pixels, _softness(picture[top : bottom + 1, left : right + 1]))


def _charuco(
    board: Board, layout: Any, picture: np.ndarray
) -> tuple[np.ndarray, np.ndarray, str | None]:
    """Numbers (c,) and pixels (c, 2) of corners in a layout, and the markers' problem, if any."""
    settings = cv2.aruco.CharucoParameters()
    settings.tryRefineMarkers = True  # searches around other markers: finds more when out of focus
    corners, numbers, *found = cv2.aruco.CharucoDetector(layout, settings).detectBoard(picture)
    places = np.array(layout.getObjPoints())[..., :2]
    problem = _problem(board, places, *_as_arrays(found[0], found[1]))
    if numbers is None:
        return np.zeros(0, int), np.zeros((0, 2)), problem
    return numbers.ravel(), corners.reshape(-1, 2) - charuco_offset(), problem


@cache
def charuco_offset() -> np.ndarray:
    """The offset (2,) [px], to the right and down, of OpenCV's corners of ChArUco boards.

    It is half a pixel in OpenCV 4.10, and zero from 4.14 on, so it is measured on a drawn board.
    """
    alphabet = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    board = cv2.aruco.CharucoBoard((4, 3), DRAWN, DRAWN * 0.75, alphabet)
    picture = cv2.GaussianBlur(board.generateImage((4 * DRAWN, 3 * DRAWN)), (0, 0), 1)
    corners, numbers, _, _ = cv2.aruco.CharucoDetector(board).detectBoard(picture)
    true = np.array(board.getChessboardCorners())[numbers.ravel(), :2] - 0.5
    return np.round(2 * np.median(corners.reshape(-1, 2) - true, axis=0)) / 2


def are_on_a_line(board: Board, numbers: np.ndarray) -> bool:
    """Whether all corners (c,) lie on one line, so that they do not determine a pose."""
    points = board.points[numbers]
    return bool(np.linalg.matrix_rank(points - points.mean(axis=0), tol=board.square / 10) < 2)


def _problem(board: Board, places: np.ndarray, markers: np.ndarray, ids: np.ndarray) -> str | None:
    """A problem of the detected markers, if any, given all places (m, 4, 2) [m] on the board."""
    if len(ids) < FEWEST_MARKERS:
        return f"it shows {len(ids)} markers of the board; expected: at least {FEWEST_MARKERS}"
    if len(np.unique(ids)) < len(ids):
        twice = next(number for number in ids if (ids == number).sum() > 1)
        return f"marker {twice} appears more than once: a second board, or a double exposure"
    numbers = ids - board.first_id
    if numbers.min() < 0 or numbers.max() >= board.markers:
        outside = ids[(numbers < 0) | (numbers >= board.markers)].max()
        return f"marker {outside} is not on the board: another board, or another first_id"
    if _misplaced(places[numbers], markers) > MISPLACED:
        return "markers are not at their places on the board: this is another board"
    return None


def _mistake(board: Board, picture: np.ndarray) -> str | None:
    """A user's mistake or a blur that explains why the board was not found."""
    if _problem(board, board.tags, *_markers(board, cv2.flip(picture, 1))) is None:
        return "it is mirrored; try: the camera's original picture"
    for name in OTHERS:
        if board.dictionary.startswith(name[:4]):
            continue
        other = replace(board, dictionary=name, first_id=0, columns=4, rows=4)
        if len(_markers(other, picture)[1]) > MANY:
            return f"its markers are of {name}, not of {board.dictionary}: this is another board"
    if (softness := _softness(picture)) > SOFT:
        return f"it is blurred, by {softness:.1f} px or more"
    return None


def _markers(
    board: Board, picture: np.ndarray, exact: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 4, 2) [px] and numbers (m,) of markers."""
    settings = cv2.aruco.DetectorParameters()
    if board.kind == APRILGRID:
        settings.markerBorderBits = KALIBR_BORDER
    elif exact:
        settings.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_APRILTAG
    detector = cv2.aruco.ArucoDetector(board.alphabet, settings)
    markers, numbers = _as_arrays(*detector.detectMarkers(picture)[:2])
    if board.kind == APRILGRID:
        return _refined_as_kalibr(board, picture, markers, numbers), numbers
    return markers - HALF * exact, numbers


def _as_arrays(corners: Any, ids: Any) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 4, 2) [px] and numbers (m,) of markers, as OpenCV returns them."""
    if ids is None:
        return np.zeros((0, 4, 2)), np.zeros(0, int)
    return np.array(corners).reshape(-1, 4, 2), ids.ravel()


def _softness(picture: np.ndarray) -> float:
    """The standard deviation [px] of the blur, from the widths of the edges of highest contrast."""
    smooth = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), SMOOTHED)
    window = np.ones((AROUND, AROUND))
    contrast = cv2.dilate(smooth, window) - cv2.erode(smooth, window)
    steepest = cv2.dilate(np.hypot(*np.gradient(smooth)), window)
    edges = contrast >= CLEAR * contrast.max()
    widths = contrast[edges] / np.maximum(steepest[edges], 1e-9) / np.sqrt(2 * np.pi)
    total = np.quantile(widths, BLURRED) if len(widths) else 0.0
    return float(np.sqrt(max(total**2 - SMOOTHED**2, 0.0)))


def _pattern(board: Board, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (c,) and pixels (c, 2) of all corners of a chessboard, or of all circles.

    Both are empty if not all of them are found.
    """
    if board.kind == CHESSBOARD:
        return _chessboard(board, picture)
    size, flags = (board.columns, board.rows), cv2.CALIB_CB_ASYMMETRIC_GRID
    for way in (flags, flags | cv2.CALIB_CB_CLUSTERING):
        whole, centres = cv2.findCirclesGrid(picture, size, flags=way)
        if whole:
            return np.arange(board.columns * board.rows), centres.reshape(-1, 2).astype(float)
    return np.zeros(0, int), np.zeros((0, 2))


def _chessboard(board: Board, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and pixels of corners, from the upper left one, which the squares' colours determine.

    If either columns or rows (not both) are even in number, only one of two opposite corners is
    dark: the upper left one. Any other board looks the same upside down, and counts as upright.
    """
    columns, rows = board.columns - 1, board.rows - 1
    flags = cv2.CALIB_CB_EXHAUSTIVE + cv2.CALIB_CB_ACCURACY + cv2.CALIB_CB_NORMALIZE_IMAGE
    whole, found = cv2.findChessboardCornersSB(picture, (columns, rows), flags=flags)
    if not whole:
        return np.zeros(0, int), np.zeros((0, 2))
    grid = found.reshape(rows, columns, 2).astype(float)
    across, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if across[0] * down[1] - across[1] * down[0] < 0:  # x to the right, y down
        grid = grid[::-1]
    if not board.same_upside_down:
        middles = (grid[:2, at : at + 2].mean(axis=(0, 1)).round().astype(int) for at in (0, 1))
        first, second = (np.median(picture[y - 1 : y + 2, x - 1 : x + 2]) for x, y in middles)
        upside_down = first > second
    else:
        upside_down = grid[0, 0].sum() > grid[-1, -1].sum()
    if upside_down:
        grid = grid[::-1, ::-1]
    return np.arange(columns * rows), grid.reshape(-1, 2)


def _refined_as_kalibr(
    board: Board, picture: np.ndarray, markers: np.ndarray, numbers: np.ndarray
) -> np.ndarray:
    """Corners (m, 4, 2) [px] of Kalibr's tags, clockwise from the upper left."""
    for tag in markers:
        side = np.linalg.norm(tag - np.roll(tag, 1, axis=0), axis=1).min()
        window = int(np.clip(NEAR * side * (board.square / board.marker - 1) * 2, *WINDOWS))
        tag[:] = cv2.cornerSubPix(
            picture, tag.reshape(4, 1, 2).copy(), (window, window), (-1, -1), REFINED
        )[:, 0]
    known = np.isin(numbers - board.first_id, np.arange(board.markers))
    if not len(numbers) or not known.all():
        return markers
    places = board.tags[numbers - board.first_id]
    turned = [np.roll(markers, step, axis=1) for step in range(4)]  # prints differ in tag rotation
    return min(turned, key=lambda corners: _misplaced(places, corners))


def _misplaced(places: np.ndarray, markers: np.ndarray) -> float:
    """The deviation of markers (m, 4, 2) [px] from a plane with these places, over their sides."""
    plane, _ = cv2.findHomography(places.reshape(-1, 2), markers.reshape(-1, 2), cv2.LMEDS)
    if plane is None:
        return np.inf
    expected = cv2.perspectiveTransform(places.astype(float), plane)
    gaps = np.linalg.norm(expected - markers, axis=-1).mean(axis=1)
    return float(np.quantile(gaps / np.linalg.norm(markers[:, 0] - markers[:, 1], axis=-1), 0.75))
