"""A station with a camera, and a live calibration that goes by the corners of its pictures."""

import csv
import io
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import Description, InvalidFile, Observations, RecalibError, StationFailed
from recalib.laboratory.command_line import REFUSED, main
from recalib.laboratory.live.record import Record
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.live.session import SOON
from recalib.station import BoardInPictures, PicturesOfABoard
from recalib.vision import Corners
from tests.bars.live import FINER, pictured
from tests.vision.rendering import Cell


@pytest.fixture(
    scope="module",
    params=[pytest.param(False, marks=pytest.mark.slow), True],
    ids=["fixed", "hand"],
)
def live(request):
    return pictured(1, request.param)


def test_it_ends_by_itself_with_less_than_half_of_the_error_of_poses(live):
    assert f"{1e3 * FINER:g} mm was requested" in live.reason
    assert len(live.rows) >= SOON, "few pictures say nothing of postures that are not seen"
    by_poses = RunningCalibration(live.station.cell.arm, Description(), live.postures)
    error = live.error(by_poses.calibration(replace(live.rows, optics=None)).predict(live.fresh))
    assert live.after < 0.2 and live.after < 0.5 * error


def test_the_predicted_error_is_about_the_true_one(live):
    """And not that of the camera's distance, of which no picture tells."""
    assert 0.5 < live.predicted / live.after < 4


def test_no_picture_is_taken_in_vain_once_there_is_a_calibration(live):
    station, running, rows = live.station, live.running, live.rows
    assert len(station.unseen) < len(rows) / 2
    for _ in range(5):
        station.move(running.next_posture(rows, []), 1.0)
        assert station.measure() is not None
        poses, optics = station.pictures([*map(str, range(1, station.taken + 1))])
        joints = np.vstack([rows.joints, station.stands])
        rows = Observations(joints, poses, optics=optics)


def opened(cell):
    """The pictures of a camera next to the arm, and the table with their rows."""
    pictures = BoardInPictures(cell.board, cell.lens, False)
    return pictures, Record("table.csv", cell.arm, Description(), pictures)


@pytest.fixture
def session(tmp_path, monkeypatch):
    """A table with three pictures, each in a row."""
    monkeypatch.chdir(tmp_path)
    cell = Cell(3)
    joints = cell.postures(3)
    pictures, record = opened(cell)
    for number, (angles, pose) in enumerate(zip(joints, cell.board_poses(joints), strict=True)):
        cv2.imwrite(f"{number}.png", cell.picture(pose))
        cells = PicturesOfABoard(Photographs(f"{number}.png"), pictures).measure()
        record.write(*record.read(angles, cells))
    record.close()
    return cell, record.observations


def read_again(cell):
    """The table by another process."""
    _, record = opened(cell)
    record.close()
    return record.observations


def test_a_calibration_that_goes_on_searches_its_pictures_again(session):
    cell, before = session
    again = read_again(cell)
    assert np.array_equal(again.measured, before.measured)
    for name in ("spread", "slopes", "information", "gradient", "pixels"):
        assert np.array_equal(getattr(again.optics, name), getattr(before.optics, name))


@pytest.mark.parametrize("change", ["removed", "empty", "another size", "another board"])
def test_a_picture_that_is_not_what_it_was_is_told_before_anything_moves(session, tmp_path, change):
    (cell, _), picture = session, tmp_path / "1.png"
    if change == "removed":
        picture.unlink()
    elif change == "empty":
        picture.write_bytes(b"")
    elif change == "another size":
        cell = replace(cell, lens=replace(cell.lens, size=(1280, 962)))
    else:
        cell = replace(cell, board=replace(cell.board, dictionary="5X5_100"))
    reason = {"removed": "there is no such file", "empty": "it is not a picture"}
    reason = reason.get(change, "it does not show the board")
    with pytest.raises(InvalidFile, match=rf"\d.png: {reason}"):
        read_again(cell)


def test_a_table_without_pictures_is_none_for_a_camera(session, tmp_path):
    cell, _ = session
    with open("table.csv", newline="") as file:
        rows = [row[:-8] + row[-7:] for row in csv.reader(file)]
    with open("table.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    with pytest.raises(InvalidFile, match="column 'picture' is missing"):
        read_again(cell)


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
    camera = PicturesOfABoard(Photographs(path), BoardInPictures(cell.board, cell.lens, in_hand))
    cells = camera.measure()
    expected = np.linalg.inv(pose) if in_hand else pose
    assert cells.pop("picture") == str(path)
    assert [cells[f"{axis} [m]"] for axis in "xyz"] == pytest.approx(expected[:3, 3], abs=2e-3)
    turn = Rotation.from_quat([cells[f"q{axis}"] for axis in "xyzw"])
    assert (turn * Rotation.from_matrix(expected[:3, :3]).inv()).magnitude() < 2e-3
    with pytest.raises(StationFailed, match="000.png is identical to the previous picture: is it"):
        camera.measure()


def test_what_is_no_picture_of_it_is_told(tmp_path, monkeypatch):
    station, cell = Photographs(tmp_path / "grey.png"), Cell(3)
    camera = PicturesOfABoard(station, BoardInPictures(cell.board, cell.lens, False))
    for cells, message in (
        ({"x [m]": 1.0}, "the station measured x .m.; expected: picture"),
        ({"picture": "nowhere.png"}, "nowhere.png: there is no such file"),
    ):
        station.measure = lambda cells=cells: cells
        with pytest.raises(RecalibError, match=message):
            camera.measure()
    del station.measure
    cv2.imwrite(str(tmp_path / "grey.png"), np.full((100, 200), 128, np.uint8))
    with pytest.raises(StationFailed, match="has 200 x 100 pixels; expected: 1280"):
        camera.measure()
    grey = np.full(cell.lens.size[::-1], 128, np.uint8)
    cv2.imwrite(str(tmp_path / "grey.png"), grey)
    assert camera.measure() is None

    def few(board, lens, view):  # `observe` would refuse them at the end
        return Corners(view.numbers[:7], view.pixels[:7], view.softness)

    monkeypatch.setattr("recalib.vision.views.good_corners", few)
    cv2.imwrite(str(tmp_path / "grey.png"), cell.picture(*cell.board_poses(cell.postures(1))))
    assert camera.measure() is None
    station.measure = lambda: None
    assert camera.measure() is None


class Still:
    """A Panda that takes a picture where it stands."""

    in_hand = False

    def __init__(self):
        cell = Cell(3, self.in_hand)
        (self.stands,) = cell.postures(1)
        self.joints, model = cell.arm.joints, cell.arm.model
        self.limits = model.lowerPositionLimit, model.upperPositionLimit
        (self.pose,) = cell.board_poses(self.stands[None])
        self.height = cell.arm.forward(self.stands[None])[0, 2, 3]
        cv2.imwrite("000.png", cell.picture(self.pose))

    def angles(self):
        return self.stands

    def measure(self):
        return {"picture": "000.png"}

    def stop(self): ...


@pytest.mark.parametrize("in_hand", [False, True], ids=["fixed", "hand"])
def test_the_options_tell_where_the_camera_is(in_hand, tmp_path, monkeypatch, capsys):
    """A board on the hand needs room above the floor."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Still, "in_hand", in_hand)
    monkeypatch.setattr("sys.stdin", io.StringIO("q\n"))
    station, cell = Still(), Cell(3, in_hand)
    Path("board.toml").write_text(cell.board.described())
    Path("lens.yaml").write_text(cell.lens.as_ros())
    words = ["live", f"{__name__}:Still", "panda.urdf", "--tool=panda_link8", "--board=board.toml"]
    words += ["--lens=lens.yaml", f"--camera={'hand' if in_hand else 'fixed'}", "--span=10 deg"]
    floor = station.height - 0.9 * np.linalg.norm(cell.board.size) / 2
    code = main([*words, f"--floor={floor} m", "--no-self-collision"])
    close = "'the tool nearer than 20 mm to the floor'" in capsys.readouterr().err
    assert (code == REFUSED) == close == (not in_hand)
    if in_hand:
        (row,) = csv.DictReader(Path("measurements.csv").read_text().splitlines())
        place = np.linalg.inv(station.pose)[:3, 3]
        assert [float(row[f"{axis} [m]"]) for axis in "xyz"] == pytest.approx(place, abs=2e-3)


def test_a_board_needs_room_for_its_pictures(tmp_path, capsys):
    (tmp_path / "new_observed").mkdir()
    (tmp_path / "new_observed" / "page.html").touch()
    words = ["live", "nowhere", "ur10_robot.urdf", "--board=board.toml", "--lens=lens.yaml"]
    assert main([*words, f"--out={tmp_path / 'new'}"]) == REFUSED
    assert "new_observed" in capsys.readouterr().err
