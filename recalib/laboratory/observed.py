"""What `observe` wrote, as observations of an arm: poses and what its pixels make of them."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import Quantity
from recalib.files.storage import read_file
from recalib.identification.observations import Observations
from recalib.identification.optics import BOARD, OPTICS
from recalib.laboratory.columns import NUMBER, Table, read_table
from recalib.laboratory.observe import CAMERAS, CORNERS, IN_HAND, LENS, SETUP
from recalib.vision.boards import MOST, read_board
from recalib.vision.detection import FEWEST, Corners
from recalib.vision.lenses import Lens, read_lens
from recalib.vision.views import optics_of

PIXEL = Quantity("a pixel", {"px": 1.0})
COLUMNS = {"row": NUMBER, "corner": NUMBER, "u": PIXEL, "v": PIXEL}


def with_pixels(observations: Observations, folder: Path) -> tuple[Observations, str, tuple[str]]:
    """Observations in a folder, whose poses are those of its pixels.

    Returns them, and the names of instrument and target: the one that stands is the instrument.

    Raises InvalidFile.
    """
    board = read_board(folder / SETUP)
    setup = tomllib.loads(read_file(folder / SETUP, MOST).decode("utf-8"))
    camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
    if camera not in CAMERAS or not isinstance(fitted, bool):
        raise InvalidFile(folder / SETUP, "camera or lens_from_pictures is not as observe wrote it")
    views = _views(read_table(folder / CORNERS), len(board.points), len(observations))
    in_hand = camera == IN_HAND
    poses, optics = optics_of(board, read_lens(folder / LENS), views, fitted, in_hand)
    names = ("the board", "the camera") if in_hand else ("the camera", "the board")
    return replace(observations, measured=poses, optics=optics), names[0], names[1:]


def fitted_lens(folder: Path, optics: np.ndarray) -> Lens:
    """The lens in a folder, with what a calibration found of the optics (o,) beside it."""
    lens = read_lens(folder / LENS)
    beside = np.zeros(len(OPTICS))
    beside[: len(optics)] = optics
    fx, fy, cx, cy, *distortion = beside[len(BOARD) :]
    matrix = lens.matrix + np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 0]])
    lens.distortion[:4] += distortion
    return Lens(lens.size, matrix, lens.distortion)


def _views(table: Table, points: int, count: int) -> list[Corners]:
    for column in COLUMNS:
        if column not in table:
            raise InvalidFile(table.path, f"column {column!r} is missing")
    row, corner, u, v = (table.numbers(column, kind) for column, kind in COLUMNS.items())
    if not np.isin(corner, np.arange(points)).all():
        raise InvalidFile(table.path, f"a corner is not among the board's {points}")
    pixels, views = np.stack([u, v], axis=1), []
    for number in range(1, count + 1):
        its = row == number
        if its.sum() < FEWEST:
            raise InvalidFile(table.path, f"row {number} has {its.sum()} corners")
        views.append(Corners(corner[its].astype(int), pixels[its], 0.0))
    return views
