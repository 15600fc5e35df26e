"""A folder that `observe` wrote: pictures of one board by one camera."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from recalib.errors import InvalidFile
from recalib.files.quantities import NUMBER, Quantity
from recalib.files.storage import read_toml
from recalib.laboratory.pictures.observed import (
    CAMERAS,
    CORNERS,
    IN_HAND,
    LENS,
    NAME,
    OBSERVED,
    PICTURE,
    SETUP,
)
from recalib.laboratory.tables.columns import PICTURES, TEXT, Columns
from recalib.laboratory.tables.measurements import Measurements, read_joints
from recalib.laboratory.tables.table import read_table
from recalib.nominal.kinematics import Arm
from recalib.spelling import counted
from recalib.vision.boards import Board, board_in
from recalib.vision.detection import FEWEST, Corners, are_on_a_line
from recalib.vision.lenses import Lens, read_lens

PIXEL = Quantity("a pixel", {"px": 1.0}, farthest=1e5)
LAYOUT = (
    Columns("pictures", (PICTURE,), TEXT, needed=True),
    Columns("corners", ("corner",), NUMBER, needed=True),
    Columns("pixels", ("u", "v"), PIXEL, needed=True),
)
MOST_CORNERS = 1_000_000
FLAT = 1e-3  # the width of corners in a picture over their length: less is a line
SMALLEST, BENT = 3.0, 0.3  # px of a board, rms; the part of that which distortion may move a corner


@dataclass(frozen=True)
class Session:
    """Pictures of a board by a camera.

    Attributes:
        folder: that observe wrote.
        camera, board_name: their names.
        in_hand: whether the camera is on the hand.
        fitted: whether the lens is estimated from the pictures.
        board, lens: in all pictures.
        rows: of the table.
        views: the corners in each row's picture.
    """

    folder: Path
    camera: str
    board_name: str
    in_hand: bool
    fitted: bool
    board: Board
    lens: Lens
    rows: Measurements
    views: list[Corners]

    @classmethod
    def read(cls, folder: Path, arm: Arm) -> "Session":
        """The session in a folder, whose table has the joints of an arm. Raises InvalidFile."""
        setup = read_toml(path := folder / SETUP)
        camera, fitted = setup.get("camera"), setup.get("lens_from_pictures")
        if camera not in CAMERAS or not isinstance(fitted, bool):
            raise InvalidFile(path, "camera or lens_from_pictures is not as observe wrote it")
        names: list[Any] = [setup.get(f"{kind}_name") for kind in ("camera", "board")]
        if not all(isinstance(name, str) and NAME.fullmatch(name) for name in names):
            raise InvalidFile(path, "camera_name or board_name is not as observe wrote it")
        board, lens = board_in(setup, path), read_lens(folder / LENS)
        rows = read_joints(folder / OBSERVED, arm)
        views = _views(folder / CORNERS, rows, board, lens.size)
        return cls(folder, names[0], names[1], camera == IN_HAND, fitted, board, lens, rows, views)

    def conflict(self, other: "Session") -> str | None:
        """Why another session cannot be in the same cell, if it cannot."""
        camera, board = self.camera == other.camera, self.board_name == other.board_name
        if camera and board:
            return (
                f"it has camera {self.camera!r} and board {self.board_name!r}, as {self.folder}"
                " has; try: observe with another --name, or all of their pictures in one folder"
            )
        sides = {True: "on the hand", False: "next to the arm"}
        if camera and self.in_hand != other.in_hand:
            return (
                f"it has camera {self.camera!r} {sides[other.in_hand]}, {self.folder} has it"
                f" {sides[self.in_hand]}; try: observe with another --name"
            )
        if board and (self.in_hand != other.in_hand or self.board != other.board):
            return (
                f"its board {self.board_name!r} differs from that in {self.folder}; try: observe"
                " with a --board of another file name"
            )
        lenses = [
            (session.fitted, session.lens.size if session.fitted else session.lens.as_ros())
            for session in (self, other)
        ]
        if camera and lenses[0] != lenses[1]:
            found = f"camera {self.camera!r} has another lens than in {self.folder}"
            return f"{found}; try: the same --lens"
        return None


def _views(path: Path, rows: Measurements, board: Board, size: tuple[int, int]) -> list[Corners]:
    """The corners in each row's picture: rows may have been taken out or moved.

    Raises InvalidFile: corners that no picture of the board can have.
    """
    if PICTURES.name not in rows.columns:
        raise InvalidFile(rows.path, f"column {PICTURE!r} is missing")
    table = read_table(path, most=MOST_CORNERS).read(LAYOUT)
    corners, points = table["corners"], board.points
    if not np.isin(corners, np.arange(len(points))).all():
        raise InvalidFile(path, f"a corner is not among the board's {len(points)}")
    views = []
    for picture in rows.columns[PICTURES.name]:
        shown = table["pictures"] == picture
        numbers, pixels = corners[shown].astype(int), table["pixels"][shown]
        if len(numbers) < FEWEST:
            raise InvalidFile(path, f"{picture} has {counted(len(numbers), 'corner')}")
        if len(np.unique(numbers)) < len(numbers):
            raise InvalidFile(path, f"{picture} has a corner twice")
        if (outside := ((pixels < -1) | (pixels > size)).any(axis=1)).any():
            u, v = pixels[outside][0]
            found = f"corner {numbers[outside][0]} of {picture} is at ({u:.6g}, {v:.6g}) px"
            raise InvalidFile(path, f"{found}; expected: inside {size[0]} x {size[1]} px")
        widths = np.linalg.svd(pixels - pixels.mean(axis=0), compute_uv=False)
        if are_on_a_line(board, numbers) or widths[1] <= FLAT * widths[0]:
            raise InvalidFile(path, f"all corners of {picture} are on a line")
        if not _are_of(points[numbers], pixels):
            found = f"corners of {picture} are not where a board of squares can have them"
            raise InvalidFile(path, f"{found}; try: remove its row")
        views.append(Corners(numbers, pixels, 0.0))
    return views


def _are_of(points: np.ndarray, pixels: np.ndarray) -> bool:
    """Whether pixels (c, 2) can be of points (c, 3) of a board, whatever the lens.

    A homography leaves the distortion of the lens. It is of a board that faces the camera.
    """
    size = np.sqrt(np.mean(np.sum((pixels - pixels.mean(axis=0)) ** 2, axis=1)))
    homography, _ = cv2.findHomography(points[:, :2], pixels) if size > SMALLEST else (None, None)
    if homography is None:
        return False
    there = cv2.perspectiveTransform(points[:, None, :2], homography)[:, 0]
    weights = points[:, :2] @ homography[2, :2] + homography[2, 2]
    off = np.linalg.norm(pixels - there, axis=1).max()
    return bool(off < BENT * size and np.linalg.det(homography) > 0 and (weights > 0).all())
