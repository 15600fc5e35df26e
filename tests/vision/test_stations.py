"""A station with a camera is one that measures poses."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import RecalibError, StationFailed
from recalib.laboratory.command_line import REFUSED, main
from recalib.station import BoardInPictures, PicturesOfABoard
from recalib.vision.detection import Corners
from tests.vision.rendering import Cell


class Photographs:
    """A station that measures whatever picture is at a path."""

    def __init__(self, path):
        self.path = path

    def measure(self):
        return {"picture": str(self.path)}


@pytest.mark.parametrize("in_hand", [False, True], ids=["fixed", "hand"])
def test_what_stands_is_measured_in_what_moves(in_hand, tmp_path):
    """The camera in the board where it is on the hand, else the board in the camera."""
    cell, path = Cell(3, in_hand), tmp_path / "000.png"
    (pose,) = cell.board_poses(cell.postures(1))
    cv2.imwrite(str(path), cell.picture(pose))
    seeing = PicturesOfABoard(Photographs(path), BoardInPictures(cell.board, cell.lens, in_hand))
    cells = seeing.measure()
    expected = np.linalg.inv(pose) if in_hand else pose
    assert cells.pop("picture") == str(path)
    assert [cells[f"{axis} [m]"] for axis in "xyz"] == pytest.approx(expected[:3, 3], abs=2e-3)
    turn = Rotation.from_quat([cells[f"q{axis}"] for axis in "xyzw"])
    assert (turn * Rotation.from_matrix(expected[:3, :3]).inv()).magnitude() < 2e-3
    with pytest.raises(StationFailed, match="000.png is the same picture as the one before: is it"):
        seeing.measure()


def test_what_is_no_picture_of_it_is_told(tmp_path):
    station, cell = Photographs(tmp_path / "grey.png"), Cell(3)
    seeing = PicturesOfABoard(station, BoardInPictures(cell.board, cell.lens, False))
    for cells, says in (
        ({"x [m]": 1.0}, "the station measured x .m.; expected: picture"),
        ({"picture": "nowhere.png"}, "nowhere.png: there is no such file"),
    ):
        station.measure = lambda cells=cells: cells
        with pytest.raises(RecalibError, match=says):
            seeing.measure()
    del station.measure
    cv2.imwrite(str(tmp_path / "grey.png"), np.full((100, 200), 128, np.uint8))
    with pytest.raises(StationFailed, match="has 200 x 100 pixels; expected, as by the lens: 1280"):
        seeing.measure()
    grey = np.full(cell.lens.size[::-1], 128, np.uint8)
    cv2.imwrite(str(tmp_path / "grey.png"), grey)
    assert seeing.measure() is None
    station.measure = lambda: None
    assert seeing.measure() is None


def test_a_picture_with_few_good_corners_is_no_sight_of_the_board(tmp_path, monkeypatch):
    """`observe` would refuse it at the end."""
    cell, path = Cell(3), tmp_path / "000.png"
    cv2.imwrite(str(path), cell.picture(*cell.board_poses(cell.postures(1))))

    def few(board, lens, view):
        return Corners(view.numbers[:7], view.pixels[:7], view.softness)

    monkeypatch.setattr("recalib.station.pictures.good_corners", few)
    pictures = BoardInPictures(cell.board, cell.lens, False)
    assert PicturesOfABoard(Photographs(path), pictures).measure() is None


def test_what_its_pictures_would_go_to_is_there_before_anything_moves(tmp_path, capsys):
    (tmp_path / "new_observed").mkdir()
    (tmp_path / "new_observed" / "page.html").touch()
    words = ["live", "nowhere", "ur10_robot.urdf", "--board=board.toml", "--lens=lens.yaml"]
    assert main([*words, f"--out={tmp_path / 'new'}"]) == REFUSED
    assert "new_observed" in capsys.readouterr().err


def test_a_board_needs_a_lens(tmp_path, capsys):
    words = ["live", "nowhere", "ur10_robot.urdf", "--tool=tool0", "--board=board.toml"]
    assert main([*words, f"--out={tmp_path / 'new'}"]) == REFUSED
    assert "--lens is missing; expected: the calibration of the lens" in capsys.readouterr().err
