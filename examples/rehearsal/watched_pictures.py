"""Watch a live calibration by pictures: the arm, each picture, and what its corners are off by.

python examples/rehearsal/watched_pictures.py examples/stations/ros2.py:RosArm arm.urdf tool0 \\
    board/board.toml lens.yaml

The camera is next to the arm. An arrow is a hundred times as long as what a corner is off by.
"""

import sys

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from watched import PANELS, UNSURE, LiveView

from recalib import LiveSettings, calibrate_live, load_arm, load_shapes
from recalib.nominal.descriptions import find_urdf
from recalib.station.opening import open_station
from recalib.station.pictures import BoardInPictures, PicturesOfABoard
from recalib.vision import Board, Corners, Lens, board_pose, read_board, read_lens
from recalib.vision.views import Sighting, reprojection

LONGER = 100  # times what a corner is off by: an arrow
BESIDE = rrb.Blueprint(
    rrb.Horizontal(PANELS.root_container, rrb.Spatial2DView(origin="picture", name="corners")),
    collapse_panels=True,
)


class ShownPictures(BoardInPictures):
    """Pictures of a board, each of which is shown with its corners when it is searched."""

    def __init__(self, rec: rr.RecordingStream, board: Board, lens: Lens, in_hand: bool) -> None:
        super().__init__(board, lens, in_hand)
        self._rec, self._board = rec, board

    def add(self, path: str, corners: Corners) -> Sighting:
        pose = board_pose(self._board, self.lens, corners)
        off, pixels = reprojection(self._board, self.lens, corners, pose), corners.pixels
        size = np.sqrt(np.mean(np.sum(off**2, axis=1)))
        self._rec.log("picture", rr.EncodedImage(path=path))
        self._rec.log(
            "picture/off", rr.Arrows2D(origins=pixels, vectors=LONGER * off, colors=UNSURE)
        )
        label = rr.Points2D(pixels.mean(axis=0), labels=f"{size:.2f} px off", colors=UNSURE)
        self._rec.log("picture/size", label)
        return super().add(path, corners)


if __name__ == "__main__":
    station, urdf, tool, board, lens = sys.argv[1:]
    arm, (shapes, _) = load_arm(urdf, tool), load_shapes(load_arm(urdf, tool), urdf)
    with rr.RecordingStream("recalib live") as rec:
        rec.spawn()  # or rec.save("live.rrd")
        view = LiveView(arm, find_urdf(urdf), rec)
        rec.send_blueprint(BESIDE)
        pictures = ShownPictures(rec, read_board(board), read_lens(lens), in_hand=False)
        calibrate_live(
            lambda: PicturesOfABoard(open_station(station), pictures),
            arm,
            "measurements.csv",
            LiveSettings(),
            on_row=view.show,
            pictures=pictures,
            shapes=shapes,
        )
