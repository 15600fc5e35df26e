"""A station with a camera is one that measures poses."""

import cv2
import numpy as np
import pytest

from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.live.calibration import LiveSettings, calibrate_live
from recalib.station.interface import StationFailed
from recalib.station.pictures import PicturesOfABoard
from tests.vision.rendering import Cell


class Photographs:
    """A cell's arm and its camera."""

    def __init__(self, folder, in_hand):
        self.cell, self.folder, self.taken = Cell(3, in_hand), folder, 0
        self.joints, model = self.cell.arm.joints, self.cell.arm.model
        self.limits = model.lowerPositionLimit, model.upperPositionLimit
        self.stands = self.cell.postures(1)[0]

    def move(self, angles, speed):
        self.stands = angles

    def angles(self):
        return self.stands

    def measure(self):
        path = self.folder / f"{self.taken:03}.png"
        try:
            picture = self.cell.picture(self.cell.board_poses(self.stands[None])[0])
        except cv2.error:  # the board is nowhere before the camera
            return None
        self.taken += 1
        cv2.imwrite(str(path), picture)
        return {"picture": str(path)}

    def stop(self):
        pass


@pytest.mark.slow
def test_pictures_calibrate_live_and_then_by_their_pixels(tmp_path):
    station = Photographs(tmp_path, in_hand=True)
    cell, table = station.cell, tmp_path / "measurements.csv"
    seeing = PicturesOfABoard(station, cell.board, cell.lens, in_hand=True)
    settings = LiveSettings(most=12, span=0.2)
    calibrate_live(lambda: seeing, cell.arm, table, settings, lambda posture: True)
    (tmp_path / "board.toml").write_text(cell.board.described())
    (tmp_path / "lens.yaml").write_text(cell.lens.as_ros())
    options = [f"--{name}={tmp_path / file}" for name, file in FILES.items()]
    out = f"--out={tmp_path / 'observed'}"
    assert main(["observe", ".", str(table), "--camera=hand", *options, out]) == DONE
    result = calibrate_arm("panda.urdf", tmp_path / "observed", tool=cell.arm.tool)
    assert result.worthwhile and len(result.observations) >= 10


FILES = {"board": "board.toml", "lens": "lens.yaml"}


def test_what_is_no_picture_of_it_is_told(tmp_path):
    station = Photographs(tmp_path, False)
    cell = station.cell
    seeing = PicturesOfABoard(station, cell.board, cell.lens, False)
    for cells, says in (
        ({"x [m]": 1.0}, "the station measured x .m.; expected: picture"),
        ({"picture": "nowhere.png"}, "nowhere.png is no picture"),
    ):
        station.measure = lambda cells=cells: cells
        with pytest.raises(StationFailed, match=says):
            seeing.measure()
    station.measure = lambda: {"picture": str(tmp_path / "grey.png")}
    cv2.imwrite(str(tmp_path / "grey.png"), np.full((10, 20), 128, np.uint8))
    with pytest.raises(StationFailed, match="has 20 x 10 pixels; expected, as by the lens: 1280 x"):
        seeing.measure()
    grey = np.full(cell.lens.size[::-1], 128, np.uint8)
    cv2.imwrite(str(tmp_path / "grey.png"), grey)
    assert seeing.measure() is None
    station.measure = lambda: None
    assert seeing.measure() is None


def test_a_board_needs_a_lens(tmp_path, capsys):
    words = ["live", "nowhere", "ur10_robot.urdf", "--tool=tool0", "--board=board.toml"]
    assert main([*words, f"--out={tmp_path / 'new'}"]) == REFUSED
    assert "--lens is missing; expected: the calibration of the lens" in capsys.readouterr().err
