"""Poses by pictures of a board, and a station that takes them as one that measures poses."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.model.optics import Optics
from recalib.station.interface import Station, StationFailed, cells_of
from recalib.vision import views
from recalib.vision.boards import FEWEST, Board
from recalib.vision.detection import Corners, Unusable, find_corners, read_picture
from recalib.vision.lenses import Lens

PICTURE = "picture"
WRONG = 5.0  # px by which corners are off: so far, by no lens that is near the true one


class BoardInPictures:
    """A board in the pictures of a camera, each of which is searched once.

    Attributes:
        board: which is in them.
        lens: of the camera, near the true one.
        in_hand: whether the camera is on the hand.
        tool_radius: m that a board around the tool link's origin takes, however it is turned.
    """

    def __init__(self, board: Board, lens: Lens, in_hand: bool):
        self.board, self.lens, self.in_hand = board, lens, in_hand
        self.tool_radius = 0.0 if in_hand else float(np.linalg.norm(board.size)) / 2
        self._sightings: dict[str, views.Sighting] = {}

    def search(self, path: str, grey: np.ndarray) -> views.Sighting | None:
        """The board in a picture (height, width) at a path; None if it is not found.

        Raises InvalidFile: the picture cannot have been taken with the lens.
        """
        try:
            found = find_corners(self.board, grey)
        except Unusable:
            return None
        view = self.board, self.lens, found
        off = views.reprojection(*view, views.board_pose(*view))
        if not (typical := float(np.median(np.linalg.norm(off, axis=1)))) < WRONG:
            reason = f"its corners deviate from the given lens by {typical:.3g} px"
            raise InvalidFile(path, f"{reason}; is it this camera's?")
        corners = views.good_corners(*view)
        return self.add(path, corners) if len(corners.numbers) >= FEWEST else None

    def add(self, path: str, corners: Corners) -> views.Sighting:
        """The board in a picture with these corners."""
        self._sightings[path] = views.sighting(self.board, self.lens, corners, True, self.in_hand)
        return self._sightings[path]

    def __call__(self, paths: Sequence[str]) -> tuple[np.ndarray, Optics]:
        """Poses (n, 4, 4) [m], and their information, with the lens to be found.

        Raises InvalidFile: the board is not in a picture, or its size is not the lens's.
        """
        for path in paths:
            if path in self._sightings:
                continue
            try:
                grey = read_picture(Path(path))
            except Unusable as error:
                raise InvalidFile(path, f"{error}; its row in the table needs it") from None
            if grey.shape[::-1] != self.lens.size or not self.search(path, grey):
                size = " x ".join(map(str, self.lens.size))
                reason = f"it does not show the board in {size} pixels"
                raise InvalidFile(path, f"{reason}, as its row in the table says")
        return views.optics_of(self.lens, [self._sightings[path] for path in paths])

    def predict(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `predicted_views`."""
        return views.predicted_views(self.board, self.lens, poses, self.in_hand)


class PicturesOfABoard:
    """The same station, which measures the pose of the board in the camera.

    Args:
        station: whose `measure` returns `picture`, the path of a file.
        pictures: what searches it. If the camera is on the hand, its pose in the board is what
            is measured.
    """

    def __init__(self, station: Station, pictures: BoardInPictures):
        self._station, self._pictures = station, pictures
        self._last: np.ndarray = np.zeros(0)

    def __getattr__(self, name: str) -> Any:
        """All else is the station's own."""
        return getattr(self._station, name)

    def measure(self) -> Mapping[str, float | str] | None:
        """See `Station.measure`: the picture and the pose; None if the board is not found.

        Raises InvalidFile: it is not a picture of this camera.
        """
        cells = self._station.measure()
        if cells is None:
            return None
        if PICTURE not in cells:
            raise StationFailed(f"the station measured {', '.join(cells)}; expected: {PICTURE}")
        path = str(cells[PICTURE])
        try:
            grey = read_picture(Path(path))
        except Unusable as error:
            raise InvalidFile(path, str(error)) from None
        if grey.shape[::-1] != (size := self._pictures.lens.size):
            found, valid = (f"{w} x {h}" for w, h in (grey.shape[::-1], size))
            raise StationFailed(f"{path} has {found} pixels; expected, as by the lens: {valid}")
        if (shown := self._pictures.search(path, grey)) is None:
            return None
        if np.array_equal(grey, self._last):
            raise StationFailed(f"{path} is the same picture as the one before: is it an old one?")
        self._last = grey
        return {PICTURE: path} | cells_of(shown.pose)
