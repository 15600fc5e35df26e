"""Boards that others print, in pictures that are drawn here as those programs lay them out."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
import pytest

from recalib import InvalidFile
from recalib.vision import Board, Unusable, board_pose, find_corners, read_board
from recalib.vision.views import reprojection
from tests.vision.rendering import LENS, PAPER, frame, photograph
from tests.vision.test_boards import BOARDS

SCALE = 5000  # texture px a m: modules are of whole ones
POSES = [
    frame([0.1, -0.2, 0.05], [0.0, 0.0, 0.55]),
    frame([0.3, 0.4, -0.4], [0.02, 0.01, 0.6]),
    frame([-0.4, 0.1, 0.3], [0.0, -0.02, 0.5]),
]


@dataclass
class Sheet:
    """Ink on paper: what another program draws, from the origin of the board on."""

    size: tuple[float, float]

    def __post_init__(self):
        shape = [round(SCALE * (side + 2 * PAPER)) for side in self.size[::-1]]
        self.ink = np.full(shape, 235, np.uint8)

    def square(self, x: float, y: float, side: float, grey: int = 20) -> None:
        low, high = (np.round(SCALE * (np.array([x, y]) + PAPER + end)) for end in (0, side))
        (left, top), (right, bottom) = low.astype(int), high.astype(int)
        self.ink[max(0, top) : bottom, max(0, left) : right] = grey

    def circle(self, x: float, y: float, radius: float) -> None:
        centre = [round(16 * (SCALE * (at + PAPER) - 0.5)) for at in (x, y)]
        cv2.circle(self.ink, centre, round(16 * SCALE * radius), 20, -1, cv2.LINE_AA, 4)

    def modules(self, x: float, y: float, side: float, black: np.ndarray) -> None:
        module = side / len(black)
        for row, column in np.ndindex(black.shape):
            grey = 20 if black[row, column] else 235
            self.square(x + column * module, y + row * module, module, grey)

    def picture(self, pose: np.ndarray) -> np.ndarray:
        """Of the sheet with its middle at a pose in the camera."""
        corner = pose @ frame([0, 0, 0], [*-np.array(self.size) / 2, 0])
        return photograph(self.ink, SCALE, LENS, corner, np.random.default_rng(0))


def bits(name: str, number: int, border: int) -> np.ndarray:
    """Which modules of a marker are black."""
    alphabet = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{name}"))
    side = alphabet.markerSize + 2 * border
    return cv2.aruco.generateImageMarker(alphabet, number, side, borderBits=border) == 0


def charuco(board: Board, dark_first: bool) -> Sheet:
    """Markers in the white squares; the upper left square is dark now, and was white before 4.6."""
    sheet = Sheet((board.columns * board.square, board.rows * board.square))
    number, gap = board.first_id, (board.square - board.marker) / 2
    for row, column in np.ndindex(board.rows, board.columns):
        x, y = column * board.square, row * board.square
        if ((row + column) % 2 == 0) == dark_first:
            sheet.square(x, y, board.square)
        else:
            sheet.modules(x + gap, y + gap, board.marker, bits(board.dictionary, number, 1))
            number += 1
    return sheet


def aprilgrid(board: Board, turned: int) -> Sheet:
    """Kalibr's: tags of two modules' border from the lower left on, with squares at all corners."""
    gap = board.square - board.marker
    sheet = Sheet((board.columns * board.square - gap, board.rows * board.square - gap))
    for row, column in np.ndindex(board.rows + 1, board.columns + 1):
        sheet.square(column * board.square - gap, row * board.square - gap, gap)
    for row, column in np.ndindex(board.rows, board.columns):
        number = board.first_id + board.columns * (board.rows - 1 - row) + column
        black = np.rot90(bits(board.dictionary, number, 2), turned)
        sheet.modules(column * board.square, row * board.square, board.marker, black)
    return sheet


def chessboard(board: Board) -> Sheet:
    sheet = Sheet((board.columns * board.square, board.rows * board.square))
    for row, column in np.ndindex(board.rows, board.columns):
        if (row + column) % 2 == 0:
            sheet.square(column * board.square, row * board.square, board.square)
    return sheet


def circles(board: Board) -> Sheet:
    """OpenCV's asymmetric grid; the origin of the board is the middle of the first circle."""
    sheet = Sheet((2 * (board.columns - 0.5) * board.square, (board.rows - 1) * board.square))
    for row, column in np.ndindex(board.rows, board.columns):
        x, y = (2 * column + row % 2) * board.square, row * board.square
        sheet.circle(x, y, 0.4 * board.square)
    return sheet


EVEN = Board("charuco", 7, 6, 0.032, 0.024, "4X4_100")
FROM_30 = Board("charuco", 7, 5, 0.036, 0.027, "5X5_250", 30)
GRID = Board("aprilgrid", 6, 5, 0.0364, 0.028, "APRILTAG_36H11")
GRID_FROM_100 = Board("aprilgrid", 4, 4, 0.045, 0.036, "APRILTAG_36H11", 100)
CHESS, CIRCLES = Board("chessboard", 9, 6, 0.025), Board("circles", 4, 11, 0.018)
SHEETS = {
    "ChArUco now": (EVEN, charuco(EVEN, True)),
    "ChArUco before 4.6": (EVEN, charuco(EVEN, False)),
    "ChArUco from 30": (FROM_30, charuco(FROM_30, True)),
    **{f"Aprilgrid {turned}": (GRID, aprilgrid(GRID, turned)) for turned in range(4)},
    "Aprilgrid from 100": (GRID_FROM_100, aprilgrid(GRID_FROM_100, 2)),
    "chessboard": (CHESS, chessboard(CHESS)),
    "circles": (CIRCLES, circles(CIRCLES)),
}


@pytest.mark.parametrize("pose", POSES, ids=["straight", "tilted", "turned"])
@pytest.mark.parametrize(("board", "sheet"), SHEETS.values(), ids=SHEETS)
def test_corners_are_where_another_program_drew_them(board, sheet, pose):
    found = find_corners(board, sheet.picture(pose))
    assert len(found.numbers) > 0.8 * len(board.points)
    true = pose @ frame([0, 0, 0], [-side / 2 for side in sheet.size] + [0])
    off = np.linalg.norm(reprojection(board, LENS, found, true), axis=1)
    assert np.median(off) < 0.15 and off.max() < 1.0
    step = board_pose(board, LENS, found)[:3, 3] - true[:3, 3]
    assert np.linalg.norm(step) < 2e-3


@pytest.mark.parametrize("half_turn", [False, True])
@pytest.mark.parametrize(("columns", "rows"), [(9, 6), (6, 9), (8, 6), (7, 5)])
def test_a_chessboard_is_known_upside_down(columns, rows, half_turn):
    """By the colour of its first square, if one number of squares is odd; else it is upright."""
    pose = POSES[0] @ frame([0, 0, np.pi * half_turn], [0, 0, 0])
    board = Board("chessboard", columns, rows, 0.025)
    sheet = chessboard(board)
    upright = (columns + rows) % 2 == 0
    true = (POSES[0] if upright else pose) @ frame([0, 0, 0], [-s / 2 for s in sheet.size] + [0])
    dark = (30 + 0.12 * sheet.picture(pose)).astype(np.uint8)
    found = board_pose(board, LENS, find_corners(board, dark))
    assert np.abs(found - true).max() < 5e-3


@pytest.mark.parametrize(("columns", "rows"), [(9, 6), (9, 7)])
def test_corners_that_are_counted_as_squares_are_named(columns, rows):
    picture = chessboard(Board("chessboard", columns, rows, 0.025)).picture(POSES[0])
    with pytest.raises(Unusable, match=f"it shows {columns} x {rows} squares; columns and rows"):
        find_corners(Board("chessboard", columns - 1, rows - 1, 0.025), picture)


@pytest.mark.parametrize("name", SHEETS)
def test_a_mirrored_print_of_markers_is_named(name):
    board, sheet = SHEETS[name]
    sheet = replace(sheet)
    sheet.ink = np.ascontiguousarray(np.fliplr(SHEETS[name][1].ink))
    picture = sheet.picture(POSES[0])
    if board.marker:
        with pytest.raises(Unusable, match="it is mirrored"):
            find_corners(board, picture)
    else:  # it is the same board, turned
        found = find_corners(board, picture)
        assert reprojection(board, LENS, found, board_pose(board, LENS, found)).std() < 0.1


@pytest.mark.parametrize("name", ["chessboard", "circles"])
def test_a_part_of_a_plain_pattern_is_refused(name):
    board, sheet = SHEETS[name]
    beside = sheet.picture(frame([0, 0, 0], [0.25, 0, 0.5]))
    part = r"it does not show all \d+ (corners of the chessboard|circ\w+)$"
    with pytest.raises(Unusable, match=part):
        find_corners(board, beside)
    with pytest.raises(Unusable, match=r"; it is blurred, by [3-5]\.\d px or more"):
        find_corners(board, cv2.GaussianBlur(beside, (0, 0), 5))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("target_type: aprilgrid\ntagCols: 6\ntagRows: 5\ntagSize: 0.028\ntagSpacing: 0.3\n", GRID),
        (
            "target_type: 'checkerboard'\ntargetCols: 8\ntargetRows: 5\n"
            "rowSpacingMeters: 0.025\ncolSpacingMeters: 0.025\n",
            CHESS,
        ),
        (
            "target_type: circlegrid\ntargetCols: 4\ntargetRows: 11\nspacingMeters: 0.018\n"
            "asymmetricGrid: True\n",
            CIRCLES,
        ),
    ],
)
def test_targets_of_kalibr_are_read(text, expected, tmp_path):
    (tmp_path / "target.yaml").write_text(text)
    board = read_board(tmp_path / "target.yaml")
    assert board.kind == expected.kind and np.allclose(board.points, expected.points)
    (tmp_path / "target.yaml").write_text(text.partition("\n")[0])
    with pytest.raises(InvalidFile, match="it is not a target of Kalibr"):
        read_board(tmp_path / "target.yaml")


@pytest.mark.parametrize("board", [*BOARDS.values(), *(board for board, _ in SHEETS.values())])
def test_each_board_is_read_as_it_is_described(board, tmp_path):
    (tmp_path / "board.toml").write_text(board.described())
    read = read_board(tmp_path / "board.toml")
    assert np.allclose(read.points, board.points)
    assert read.described() == board.described()
