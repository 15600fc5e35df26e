"""Boards of markers that a camera can measure, and the TOML that describes them."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from os import PathLike
from typing import Any

import cv2
import numpy as np

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.quantities import LENGTH
from recalib.files.toml import read_toml

CHARUCO, APRILTAG = KINDS = "charuco", "apriltag"
DICTIONARY = "4X4_100"  # of the boards that we print
BORDER = 1  # modules of black around the bits of a marker
WHITE = 2  # modules of white in a square, or between tags
SMALLEST, LARGEST = 1e-3, 1.0  # m, of a square


@dataclass(frozen=True)
class Board:
    """A flat board. Its x axis goes along a row and its y axis down, so that z points into it.

    Attributes:
        kind: charuco or apriltag.
        columns, rows: of squares, or of tags.
        square: m, the side of a square, or from a tag to the next.
        marker: m, the side of a marker.
        dictionary: that of OpenCV, without `DICT_`.
    """

    kind: str
    columns: int
    rows: int
    square: float
    marker: float
    dictionary: str

    def __post_init__(self) -> None:
        """Raise InvalidSetting unless there can be such a board."""
        if self.kind not in KINDS:
            raise InvalidSetting("kind", self.kind, " or ".join(KINDS))
        for name in ("columns", "rows"):
            if not isinstance(getattr(self, name), int) or not 2 <= getattr(self, name) <= 50:
                raise InvalidSetting(name, getattr(self, name), "a whole number from 2 to 50")
        if not SMALLEST <= self.square <= LARGEST:
            valid = f"from {1e3 * SMALLEST:g} mm to {LARGEST:g} m"
            raise InvalidSetting("square", f"{1e3 * self.square:g} mm", valid)
        if not 0 < self.marker < self.square:
            raise InvalidSetting("marker", f"{1e3 * self.marker:g} mm", "less than the square")
        if not hasattr(cv2.aruco, f"DICT_{self.dictionary}"):
            raise InvalidSetting("dictionary", self.dictionary, "one of OpenCV, such as 4X4_100")
        if self.markers > (most := len(self.alphabet.bytesList)):
            found = f"{self.columns} x {self.rows}, with {self.markers} markers"
            valid = f"at most {most} markers: {self.dictionary} has no more"
            raise InvalidSetting("columns x rows", found, valid)

    @property
    def markers(self) -> int:
        """How many there are."""
        return self.columns * self.rows // (2 if self.kind == CHARUCO else 1)

    @property
    def alphabet(self) -> Any:
        """OpenCV's dictionary of its markers."""
        return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{self.dictionary}"))

    @cached_property
    def drawn(self) -> Any:
        """OpenCV's own board."""
        size, alphabet = (self.columns, self.rows), self.alphabet
        if self.kind == CHARUCO:
            return cv2.aruco.CharucoBoard(size, self.square, self.marker, alphabet)
        return cv2.aruco.GridBoard(size, self.marker, self.square - self.marker, alphabet)

    @cached_property
    def points(self) -> np.ndarray:
        """Where the corners (c, 3) [m] are that are looked for, by their numbers."""
        inner = self.kind == CHARUCO
        corners = self.drawn.getChessboardCorners() if inner else self.drawn.getObjPoints()
        return np.array(corners, dtype=float).reshape(-1, 3)

    @property
    def modules(self) -> np.ndarray:
        """Which modules (down, across) are black, if gaps are as wide as two modules."""
        pitch = self.alphabet.markerSize + 2 * BORDER + WHITE
        size = pitch * np.array([self.columns, self.rows])
        if self.kind == APRILTAG:
            size -= WHITE
        return self.drawn.generateImage([int(side) for side in size]) == 0

    @property
    def size(self) -> np.ndarray:
        """Width and height [m]."""
        gap = 0.0 if self.kind == CHARUCO else self.square - self.marker
        return self.square * np.array([self.columns, self.rows]) - gap

    def described(self) -> str:
        """The part of a TOML that `read_board` reads."""
        lengths = {name: f'"{1e3 * getattr(self, name):.6g} mm"' for name in ("square", "marker")}
        lines = [
            f"{part.name} = {lengths.get(part.name) or repr(getattr(self, part.name))}"
            for part in fields(self)
        ]
        return "\n".join(["[board]", *lines, ""]).replace("'", '"')


def printable(columns: int, rows: int, square: float) -> Board:
    """A ChArUco board whose markers are of as many modules as its gaps are.

    Raises InvalidSetting.
    """
    modules = 4 + 2 * BORDER
    marker = square * modules / (modules + WHITE)
    return Board(CHARUCO, columns, rows, square, marker, DICTIONARY)


def read_board(path: str | PathLike[str]) -> Board:
    """The board in the TOML at `path`. Raises InvalidFile, which names the key."""
    return board_in(read_toml(path), path)


def board_in(parts: Mapping[str, Any], path: str | PathLike[str]) -> Board:
    """The board in what was read of a TOML; its path is for messages. Raises InvalidFile."""
    given, names = parts.get("board"), [part.name for part in fields(Board)]
    try:
        if not isinstance(given, dict) or sorted(given) != sorted(names):
            raise InvalidSetting("[board]", given, ", ".join(names))
        lengths = {name: LENGTH.value_of(name, given[name]) for name in ("square", "marker")}
        return Board(**given | lengths | {"dictionary": str(given["dictionary"]).upper()})
    except InvalidSetting as error:
        raise InvalidFile(path, str(error)) from None
