"""A station that takes pictures of a board, as one that measures where the board is."""

from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from recalib.station.interface import Station, StationFailed
from recalib.vision.boards import Board
from recalib.vision.detection import Unusable, find_corners
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

    @property
    def joints(self) -> Sequence[str]:
        """See `Station.joints`."""
        return self._station.joints

    @property
    def limits(self) -> tuple[np.ndarray, np.ndarray]:
        """See `Station.limits`."""
        return self._station.limits

    def move(self, angles: np.ndarray, speed: float) -> None:
        """See `Station.move`."""
        self._station.move(angles, speed)

    def angles(self) -> np.ndarray:
        """See `Station.angles`."""
        return self._station.angles()

    def measure(self) -> Mapping[str, float | str] | None:
        """See `Station.measure`: the picture and the pose; None where the board is not found."""
        cells = self._station.measure()
        if cells is None:
            return None
        if PICTURE not in cells:
            raise StationFailed(f"the station measured {', '.join(cells)}; expected: {PICTURE}")
        path = str(cells[PICTURE])
        grey = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
        if grey is None:
            raise StationFailed(f"{path} is no picture")
        if grey.shape[::-1] != self._lens.size:
            found, valid = (f"{w} x {h}" for w, h in (grey.shape[::-1], self._lens.size))
            raise StationFailed(f"{path} has {found} pixels; expected, as by the lens: {valid}")
        try:
            corners = find_corners(self._board, grey)
        except Unusable:
            return None
        pose = board_pose(self._board, self._lens, good_corners(self._board, self._lens, corners))
        if self._in_hand:
            pose = np.linalg.inv(pose)
        x, y, z = pose[:3, 3].tolist()
        qx, qy, qz, qw = Rotation.from_matrix(pose[:3, :3]).as_quat().tolist()
        place = {"x [m]": x, "y [m]": y, "z [m]": z}
        return {PICTURE: path, **place, "qx": qx, "qy": qy, "qz": qz, "qw": qw}

    def stop(self) -> None:
        """See `Station.stop`."""
        self._station.stop()

    def close(self) -> None:
        """Let go of the station, if it wants that."""
        getattr(self._station, "close", lambda: None)()
