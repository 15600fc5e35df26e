"""A station that takes pictures of a board, as one that measures where the board is."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from recalib.station.interface import Station, StationFailed, cells_of
from recalib.vision.boards import Board
from recalib.vision.detection import FEWEST, Unusable, find_corners, read_picture
from recalib.vision.lenses import Lens
from recalib.vision.views import board_pose, good_corners

PICTURE = "picture"


class PicturesOfABoard:
    """The same station, which measures the pose of the board in the camera.

    Args:
        station: whose `measure` returns `picture`, the path of a file.
        board: which is in it.
        lens: of the camera, which counts as exact.
        in_hand: whether the camera is on the hand: then it is the pose of the camera in the board.
    """

    def __init__(self, station: Station, board: Board, lens: Lens, in_hand: bool):
        self._station, self._board, self._lens, self._in_hand = station, board, lens, in_hand
        self._last: np.ndarray = np.zeros(0)

    def __getattr__(self, name: str) -> Any:
        """All else is the station's own."""
        return getattr(self._station, name)

    def measure(self) -> Mapping[str, float | str] | None:
        """See `Station.measure`: the picture and the pose; None where the board is not found."""
        cells = self._station.measure()
        if cells is None:
            return None
        if PICTURE not in cells:
            raise StationFailed(f"the station measured {', '.join(cells)}; expected: {PICTURE}")
        path = str(cells[PICTURE])
        grey = read_picture(Path(path))
        if grey is None:
            raise StationFailed(f"{path} is no picture")
        if grey.shape[::-1] != self._lens.size:
            found, valid = (f"{w} x {h}" for w, h in (grey.shape[::-1], self._lens.size))
            raise StationFailed(f"{path} has {found} pixels; expected, as by the lens: {valid}")
        try:
            corners = find_corners(self._board, grey)
        except Unusable:
            return None
        if np.array_equal(grey, self._last):
            raise StationFailed(f"{path} is the same picture as the one before: is it an old one?")
        self._last = grey
        good = good_corners(self._board, self._lens, corners)
        if len(good.numbers) < FEWEST:
            return None
        pose = board_pose(self._board, self._lens, good)
        return {PICTURE: path} | cells_of(np.linalg.inv(pose) if self._in_hand else pose)
