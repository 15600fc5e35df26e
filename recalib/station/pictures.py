"""Pictures of a board: what they say, and a station that takes them as one that measures poses."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.model.optics import Optics
from recalib.station.interface import Station, StationFailed, cells_of
from recalib.vision.boards import Board
from recalib.vision.detection import FEWEST, Corners, Unusable, find_corners, read_picture
from recalib.vision.lenses import Lens
from recalib.vision.views import Sighting, good_corners, optics_of, predicted_views, sighting

PICTURE = "picture"


class BoardInPictures:
    """A board in the pictures of a camera, each of which is searched once.

    Args:
        board: which is in them.
        lens: of the camera, near the true one.
        in_hand: whether the camera is on the hand.
    """

    def __init__(self, board: Board, lens: Lens, in_hand: bool):
        self.lens, self._setup = lens, (board, lens, in_hand)
        self._sightings: dict[str, Sighting] = {}

    def search(self, path: str, grey: np.ndarray) -> Sighting | None:
        """What a picture (height, width) at a path says; None where the board is not found."""
        board, lens, _ = self._setup
        try:
            corners = good_corners(board, lens, find_corners(board, grey))
        except Unusable:
            return None
        return self.add(path, corners) if len(corners.numbers) >= FEWEST else None

    def add(self, path: str, corners: Corners) -> Sighting:
        """What a picture says with these corners."""
        board, lens, in_hand = self._setup
        self._sightings[path] = sighting(board, lens, corners, True, in_hand)
        return self._sightings[path]

    def __call__(self, paths: Sequence[str]) -> tuple[np.ndarray, Optics]:
        """Poses (n, 4, 4) [m], and what is known of them, with the lens to be found.

        Raises InvalidFile: the board is not in a picture, or its size is not that of the lens.
        """
        for path in paths:
            if path in self._sightings:
                continue
            grey = read_picture(Path(path)) if Path(path).is_file() else None
            if grey is None or grey.shape[::-1] != self.lens.size or not self.search(path, grey):
                size = " x ".join(map(str, self.lens.size))
                reason = (
                    f"it does not show the board in {size} pixels, as its row in the table says"
                )
                raise InvalidFile(path, reason)
        return optics_of([self._sightings[path] for path in paths])

    def predict(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `predicted_views`."""
        board, lens, in_hand = self._setup
        return predicted_views(board, lens, poses, in_hand)


class PicturesOfABoard:
    """The same station, which measures the pose of the board in the camera.

    Args:
        station: whose `measure` returns `picture`, the path of a file.
        pictures: what searches it. Where the camera is on the hand, its pose in the board is what
            is measured.
    """

    def __init__(self, station: Station, pictures: BoardInPictures):
        self._station, self._pictures = station, pictures
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
        if grey.shape[::-1] != (size := self._pictures.lens.size):
            its, valid = (f"{w} x {h}" for w, h in (grey.shape[::-1], size))
            raise StationFailed(f"{path} has {its} pixels; expected, as by the lens: {valid}")
        if (found := self._pictures.search(path, grey)) is None:
            return None
        if np.array_equal(grey, self._last):
            raise StationFailed(f"{path} is the same picture as the one before: is it an old one?")
        self._last = grey
        return {PICTURE: path} | cells_of(found.pose)
