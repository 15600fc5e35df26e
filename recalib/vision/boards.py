"""Calibration boards, and the TOML files that describe them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import yaml

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.quantities import LENGTH
from recalib.files.storage import read_file, read_toml
from recalib.spelling import counted, listed

CHARUCO, APRILTAG, APRILGRID = "charuco", "apriltag", "aprilgrid"
CHESSBOARD, CIRCLES = "chessboard", "circles"
KINDS = CHARUCO, APRILTAG, APRILGRID, CHESSBOARD, CIRCLES
PLAIN = CHESSBOARD, CIRCLES  # without markers: pictures must show them as a whole
SHAPE = "kind", "columns", "rows", "square"
MARKERS = "marker", "dictionary", "first_id"
LENGTHS = "square", "marker"
KALIBR = {"aprilgrid": APRILGRID, "checkerboard": CHESSBOARD, "circlegrid": CIRCLES}
DICTIONARY = "4X4_100"  # of our printed boards
BORDER = 1  # black modules around the bits of a marker; Kalibr's markers have 2
WHITE = 2  # white modules in a square, or between tags
MOST = 100_000  # bytes in a file
FEWEST = 8  # corners
SMALLEST, LARGEST = 1e-3, 1.0  # m: limits on the side of a square


@dataclass(frozen=True)
class Board:
    """A flat board. Its x axis points along a row, its y axis down, and its z axis into the board.

    Attributes:
        kind: one of `KINDS`: squares with markers in the white ones, a grid of tags, Kalibr's grid
            of tags with black squares between them, plain squares, an asymmetric grid of circles.
        columns, rows: numbers of squares or tags; of circles as OpenCV counts them, e.g. (4, 11).
        square: m, the side of a square, or the pitch of tags or of rows of circles.
        marker: m, the side of a marker; 0 for boards without markers.
        dictionary: OpenCV's name of the dictionary, without `DICT_`; empty without markers.
        first_id: the number of the first marker.
    """

    kind: str
    columns: int
    rows: int
    square: float
    marker: float = 0.0
    dictionary: str = ""
    first_id: int = 0

    def __post_init__(self) -> None:
        """Raise InvalidSetting if such a board is impossible."""
        if self.kind not in KINDS:
            raise InvalidSetting("kind", self.kind, listed(KINDS, "or"))
        for name in ("columns", "rows"):
            if not isinstance(getattr(self, name), int) or not 2 <= getattr(self, name) <= 50:
                raise InvalidSetting(name, getattr(self, name), "a whole number from 2 to 50")
        if not SMALLEST <= self.square <= LARGEST:
            valid = f"from {1e3 * SMALLEST:g} mm to {LARGEST:g} m"
            raise InvalidSetting("square", f"{1e3 * self.square:g} mm", valid)
        if self.kind not in PLAIN:
            self._check_markers()
        if (corners := len(self.points)) < FEWEST:
            found = f"{self.columns} x {self.rows}, with {counted(corners, 'corner')}"
            raise InvalidSetting("columns x rows", found, f"at least {FEWEST} corners")

    def _check_markers(self) -> None:
        if not 0 < self.marker < self.square:
            raise InvalidSetting("marker", f"{1e3 * self.marker:g} mm", "less than the square")
        if not hasattr(cv2.aruco, f"DICT_{self.dictionary}"):
            raise InvalidSetting("dictionary", self.dictionary, "one of OpenCV, such as 4X4_100")
        most = len(self.alphabet.bytesList)
        if not isinstance(self.first_id, int) or not 0 <= self.first_id < most:
            raise InvalidSetting("first_id", self.first_id, f"a whole number from 0 to {most - 1}")
        if self.first_id + self.markers > most:
            found = f"{self.columns} x {self.rows}, with {self.markers} markers"
            valid = f"at most {most - self.first_id} markers: {self.dictionary} has {most} in all"
            raise InvalidSetting("columns x rows", found, valid)

    @property
    def markers(self) -> int:
        """The number of markers."""
        return self.columns * self.rows // (2 if self.kind == CHARUCO else 1)

    @property
    def alphabet(self) -> Any:
        """OpenCV's dictionary of the markers."""
        return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{self.dictionary}"))

    @cached_property
    def drawn(self) -> Any:
        """OpenCV's object for a board with markers."""
        size, alphabet = (self.columns, self.rows), self.alphabet
        numbers = self.first_id + np.arange(self.markers)
        if self.kind == CHARUCO:
            return cv2.aruco.CharucoBoard(size, self.square, self.marker, alphabet, numbers)
        return cv2.aruco.GridBoard(size, self.marker, self.square - self.marker, alphabet, numbers)

    @cached_property
    def points(self) -> np.ndarray:
        """Positions (c, 3) [m] of the points to detect, in the order of their numbers."""
        if self.kind == CHARUCO:
            return np.array(self.drawn.getChessboardCorners(), dtype=float).reshape(-1, 3)
        down, across = np.mgrid[: self.rows, : self.columns]
        if self.kind == CIRCLES:
            across = 2 * across + down % 2
        flat = self.square * np.stack([across, down], axis=-1)
        if self.kind == CHESSBOARD:
            flat = flat[1:, 1:]
        elif self.kind != CIRCLES:
            flat = self.tags
        return np.pad(flat.reshape(-1, 2), ((0, 0), (0, 1)))

    @cached_property
    def tags(self) -> np.ndarray:
        """Corners (m, 4, 2) [m] of markers from `first_id` on, clockwise from the upper left."""
        corners = np.array(self.drawn.getObjPoints(), dtype=float)[..., :2]
        if self.kind != APRILGRID:
            return corners
        grid = corners.reshape(self.rows, self.columns, 4, 2)  # Kalibr counts from the lowest row
        return grid[::-1].reshape(-1, 4, 2)

    @property
    def same_upside_down(self) -> bool:
        """Whether the board looks the same after half a turn, which reverses its points' order."""
        return {CHESSBOARD: self.columns + self.rows, CIRCLES: self.rows}.get(self.kind, 1) % 2 == 0

    @property
    def modules(self) -> np.ndarray:
        """A mask (down, across) of the black modules, if gaps are two modules wide."""
        pitch = self.alphabet.markerSize + 2 * BORDER + WHITE
        size = pitch * np.array([self.columns, self.rows])
        if self.kind == APRILTAG:
            size -= WHITE
        return self.drawn.generateImage([int(side) for side in size]) == 0

    @property
    def size(self) -> np.ndarray:
        """The width and height (2,) [m] of the board."""
        gap = self.square - self.marker if self.kind in (APRILTAG, APRILGRID) else 0.0
        return self.square * np.array([self.columns, self.rows]) - gap

    def described(self) -> str:
        """The board's section of a TOML file, as `read_board` reads it."""
        lengths = {name: f'"{1e3 * getattr(self, name):.6g} mm"' for name in LENGTHS}
        lines = [
            f"{name} = {lengths.get(name) or repr(getattr(self, name))}"
            for name in (SHAPE if self.kind in PLAIN else SHAPE + MARKERS)
        ]
        return "\n".join(["[board]", *lines, ""]).replace("'", '"')


def printable(columns: int, rows: int, square: float) -> Board:
    """A ChArUco board whose markers and gaps consist of whole modules of equal size.

    Raises InvalidSetting.
    """
    modules = 4 + 2 * BORDER
    marker = square * modules / (modules + WHITE)
    return Board(CHARUCO, columns, rows, square, marker, DICTIONARY)


def read_board(path: str | PathLike[str]) -> Board:
    """The board in the TOML, or in Kalibr's YAML, at `path`. Raises InvalidFile, with the key."""
    if Path(path).suffix in (".yaml", ".yml"):
        return _board_of_kalibr(path)
    return board_in(read_toml(path), path)


def board_in(parts: Mapping[str, Any], path: str | PathLike[str]) -> Board:
    """The board in the content of a TOML; `path` is for messages. Raises InvalidFile."""
    given = parts.get("board")
    try:
        plain = isinstance(given, dict) and given.get("kind") in PLAIN
        names = {*SHAPE} if plain else {*SHAPE, *MARKERS}
        if not isinstance(given, dict) or {*given} not in (names, names - {"first_id"}):
            raise InvalidSetting("[board]", given, ", ".join(SHAPE if plain else SHAPE + MARKERS))
        lengths = {name: LENGTH.value_of(name, given[name]) for name in LENGTHS if name in given}
        dictionary = str(given.get("dictionary", "")).upper()
        return Board(**given | lengths | {"dictionary": dictionary})
    except InvalidSetting as error:
        raise InvalidFile(path, str(error)) from None


def _board_of_kalibr(path: str | PathLike[str]) -> Board:
    """The board in a YAML file of a Kalibr target. Raises InvalidFile."""
    try:
        given = yaml.safe_load(read_file(path, MOST))
        kind = KALIBR[given["target_type"]]
        if kind == APRILGRID:
            side, gap = float(given["tagSize"]), float(given["tagSpacing"])
            shape = int(given["tagCols"]), int(given["tagRows"])
            return Board(kind, *shape, side * (1 + gap), side, "APRILTAG_36H11")
        columns, rows = int(given["targetCols"]), int(given["targetRows"])
        if kind == CIRCLES:
            if given["asymmetricGrid"]:
                return Board(kind, columns, rows, float(given["spacingMeters"]))
            raise InvalidFile(path, "its circles are symmetric; expected: an asymmetric grid")
        down, across = float(given["rowSpacingMeters"]), float(given["colSpacingMeters"])
        if down != across:
            raise InvalidFile(path, f"its squares are {down} x {across} m; expected: equal sides")
        return Board(kind, columns + 1, rows + 1, down)  # Kalibr counts corners
    except InvalidSetting as error:
        raise InvalidFile(path, str(error)) from None
    except (yaml.YAMLError, RecursionError, KeyError, TypeError, ValueError):
        valid = f"target_type: {listed(KALIBR, 'or')}, with its keys"
        raise InvalidFile(path, f"it is not a target of Kalibr; expected: {valid}") from None
