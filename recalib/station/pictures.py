"""Poses from pictures of a board, and the use of a station that takes pictures to measure poses."""

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
WRONG = 5.0  # px, the median reprojection error from which the lens must be another camera's


class BoardInPictures:
    """The sightings of a board in the pictures of a camera; each picture is searched once.

    Attributes:
        board: the board in the pictures.
        lens: an approximate lens of the camera.
        in_hand: whether the camera is on the hand.
        tool_radius: m, the radius around the tool link's origin that a board takes in any pose.
    """

    def __init__(self, board: Board, lens: Lens, in_hand: bool):
        self.board, self.lens, self.in_hand = board, lens, in_hand
        self.tool_radius = 0.0 if in_hand else float(np.linalg.norm(board.size)) / 2
        self._sightings: dict[str, views.Sighting] = {}

    def search(self, path: str, grey: np.ndarray) -> views.Sighting | None:
        """The sighting of the board in a picture (height, width) at a path; None if not found.

        Raises InvalidFile: the picture cannot have been taken with this lens.
        """
        try:
            found = find_corners(self.board, grey)
        except Unusable:
            return None
        view = self.board, self.lens, found
        off = views.reprojection(*view, views.board_pose(*view))
        if not (typical := float(np.median(np.linalg.norm(off, axis=1)))) < WRONG:
            reason = f"its corners deviate by {typical:.3g} px with the given lens"
            raise InvalidFile(path, f"{reason}; is the lens that of this camera?")
        corners = views.good_corners(*view)
        return self.add(path, corners) if len(corners.numbers) >= FEWEST else None

    def add(self, path: str, corners: Corners) -> views.Sighting:
        """The sighting of the board in a picture with these corners, which is stored."""
        self._sightings[path] = views.sighting(self.board, self.lens, corners, True, self.in_hand)
        return self._sightings[path]

    def __call__(self, paths: Sequence[str]) -> tuple[np.ndarray, Optics]:
        """Poses (n, 4, 4) [m] from pictures, and their information, also on the lens.

        Raises InvalidFile: a picture does not show the board, or has another size than the lens.
        """
        for path in paths:
            if path in self._sightings:
                continue
            try:
                grey = read_picture(Path(path))
            except Unusable as error:
                raise InvalidFile(path, f"{error}; a row of the table refers to it") from None
            if grey.shape[::-1] != self.lens.size or not self.search(path, grey):
                size = " x ".join(map(str, self.lens.size))
                reason = f"it does not show the board in {size} pixels"
                raise InvalidFile(path, f"{reason}, although a row of the table refers to it")
        return views.optics_of(self.lens, [self._sightings[path] for path in paths])

    def predict(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Predictions for pictures at poses (n, 4, 4) [m]; see `predicted_views`."""
        return views.predicted_views(self.board, self.lens, poses, self.in_hand)


class PicturesOfABoard:
    """A wrapper around a station with a camera, which measures the pose of the board in the camera.

    Args:
        station: a station whose `measure` returns `picture`, the path of a file.
        pictures: the search for the board. If the camera is on the hand, the measurement is the
            camera's pose in the board.
    """

    def __init__(self, station: Station, pictures: BoardInPictures):
        self._station, self._pictures = station, pictures
        self._last: np.ndarray = np.zeros(0)

    def __getattr__(self, name: str) -> Any:
        """All other attributes are those of the station."""
        return getattr(self._station, name)

    def measure(self) -> Mapping[str, float | str] | None:
        """The picture and the pose, as in `Station.measure`; None if the board is not found.

        Raises InvalidFile: the file is not a picture from this camera.
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
            raise StationFailed(f"{path} has {found} pixels; expected: {valid}, as the lens has")
        if (shown := self._pictures.search(path, grey)) is None:
            return None
        if np.array_equal(grey, self._last):
            raise StationFailed(f"{path} is identical to the previous picture: is it an old one?")
        self._last = grey
        return {PICTURE: path} | cells_of(shown.pose)
