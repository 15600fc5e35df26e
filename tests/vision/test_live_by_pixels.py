"""A live calibration with a camera goes by the corners of its pictures."""

import csv
from dataclasses import replace

import cv2
import numpy as np
import pytest

from recalib import Description, InvalidFile, Observations
from recalib.laboratory.live.record import Record
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.live.session import SOON
from recalib.station import BoardInPictures, PicturesOfABoard
from tests.bars.live import FINER, pictured
from tests.vision.rendering import Cell
from tests.vision.test_stations import Photographs


@pytest.fixture(
    scope="module",
    params=[pytest.param(False, marks=pytest.mark.slow), True],
    ids=["fixed", "hand"],
)
def live(request):
    return pictured(1, request.param)


def with_row(station, rows):
    """Rows with the picture that was taken last."""
    paths = [str(number) for number in range(1, station.taken + 1)]
    poses, optics = station.pictures(paths)
    return Observations(np.vstack([rows.joints, station.stands]), poses, optics=optics)


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
        rows = with_row(station, rows)


@pytest.fixture
def begun(tmp_path, monkeypatch):
    """A table with three pictures, each in a row."""
    monkeypatch.chdir(tmp_path)
    cell = Cell(3)
    joints = cell.postures(3)
    pictures = BoardInPictures(cell.board, cell.lens, False)
    record = Record("table.csv", cell.arm, Description(), pictures)
    for number, (angles, pose) in enumerate(zip(joints, cell.board_poses(joints), strict=True)):
        cv2.imwrite(f"{number}.png", cell.picture(pose))
        cells = PicturesOfABoard(Photographs(f"{number}.png"), pictures).measure()
        record.write(*record.read(angles, cells))
    record.close()
    return cell, record.observations


def read_again(cell):
    """The table by another process."""
    record = Record(
        "table.csv", cell.arm, Description(), BoardInPictures(cell.board, cell.lens, False)
    )
    record.close()
    return record.observations


def test_a_calibration_that_goes_on_searches_its_pictures_again(begun):
    cell, before = begun
    again = read_again(cell)
    assert np.array_equal(again.measured, before.measured)
    for name in ("spread", "slopes", "information", "gradient", "pixels"):
        assert np.array_equal(getattr(again.optics, name), getattr(before.optics, name))


@pytest.mark.parametrize("gone", ["removed", "empty", "another size", "another board"])
def test_a_picture_that_is_not_what_it_was_is_told_before_anything_moves(begun, tmp_path, gone):
    (cell, _), picture = begun, tmp_path / "1.png"
    if gone == "removed":
        picture.unlink()
    elif gone == "empty":
        picture.write_bytes(b"")
    elif gone == "another size":
        cell = replace(cell, lens=replace(cell.lens, size=(1280, 962)))
    else:
        cell = replace(cell, board=replace(cell.board, dictionary="5X5_100"))
    reason = {"removed": "there is no such file", "empty": "it is not a picture"}
    with pytest.raises(
        InvalidFile, match=rf"\d.png: {reason.get(gone, 'it does not show the board')}"
    ):
        read_again(cell)


def test_a_table_without_pictures_is_none_for_a_camera(begun, tmp_path):
    cell, _ = begun
    with open("table.csv", newline="") as file:
        rows = [row[:-8] + row[-7:] for row in csv.reader(file)]
    with open("table.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    with pytest.raises(InvalidFile, match="column 'picture' is missing"):
        read_again(cell)
