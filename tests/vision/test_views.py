"""What corners say: of pictures, of lens and board, and of an arm."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from PIL import ExifTags, Image

from recalib.identification.model import displacements
from recalib.vision import Lens, Unusable, board_pose, find_corners, optics_of, printable, sighting
from recalib.vision.detection import read_picture
from recalib.vision.views import good_corners, predicted_views
from tests.bars.pictures import NOISE
from tests.vision.rendering import BOARD, LENS, Cell, frame

PLACES = pytest.mark.parametrize("in_hand", [False, True], ids=["fixed", "hand"])


@pytest.fixture(scope="module")
def cell():
    return Cell(1, in_hand=True)


@pytest.fixture(scope="module")
def poses(cell):
    return cell.board_poses(cell.postures(3))


def test_corners_are_found_where_they_are_and_their_blur_is_measured_in_pixels(cell, poses):
    """Also along half of the edges."""
    for pose in poses:
        found = find_corners(BOARD, cell.picture(pose))
        gaps = found.pixels - cell.project(pose)[found.numbers]
        assert len(found.numbers) == len(BOARD.points) and np.sqrt(np.mean(gaps**2)) < 0.1
    still = cell.picture(poses[1], blur=0.5)
    moved = cv2.blur(still, (8, 1))  # by 8 px to the side: a deviation of 8 / sqrt(12)
    found = find_corners(BOARD, moved)
    assert found.softness == pytest.approx(8 / np.sqrt(12), rel=0.3)
    for blur in (0.8, 1.5, 2.5):
        found = find_corners(BOARD, cell.picture(poses[0], blur=blur))
        assert found.softness == pytest.approx(blur, abs=0.25)


def test_a_picture_of_no_use_is_refused_with_its_reason(cell, poses):
    first, second, _ = (cell.picture(pose) for pose in poses)
    other = replace(cell, board=replace(BOARD, dictionary="5X5_100"))
    turned = replace(cell, board=printable(5, 7, 0.036))
    larger = replace(cell, board=printable(9, 7, 0.03))
    reasons = {
        "marker 30 is not on the board: another board": larger.picture(poses[0]),
        "it is mirrored": cv2.flip(first, 1),
        "it is blurred": cell.picture(poses[0], blur=9),
        "more than once": np.maximum(first, np.roll(first, 640, axis=1)),
        "its markers are of 5X5_250, not of 4X4_100": other.picture(poses[0]),
        "not at their places on the board": turned.picture(poses[0]),
        "it shows 0 markers": np.full_like(second, 90),
    }
    for reason, picture in reasons.items():
        with pytest.raises(Unusable, match=reason):
            find_corners(BOARD, picture)


@pytest.mark.parametrize("orientation", [1, 3, 6, 8])
def test_a_picture_is_as_the_sensor_has_it_however_it_was_held(orientation, tmp_path):
    ramp, exif = np.linspace(0, 255, 64, dtype=np.uint8) * np.ones((48, 1), np.uint8), Image.Exif()
    exif[ExifTags.Base.Orientation] = orientation
    Image.fromarray(ramp).save(tmp_path / "a.jpg", quality=100, exif=exif)
    assert np.abs(read_picture(tmp_path / "a.jpg").astype(int) - ramp).max() < 5


def test_a_corner_that_is_off_is_left_out(cell, poses):
    view = cell.view(poses[0], NOISE, np.random.default_rng(5))
    view.pixels[7] += 5
    numbers = good_corners(BOARD, LENS, view).numbers
    assert 7 not in numbers and len(numbers) > len(view.pixels) - 4


@PLACES
def test_poses_move_with_optics_as_it_is_said(in_hand):
    cell = Cell(2, in_hand)
    (pose,) = cell.board_poses(cell.postures(1))
    view = cell.view(pose)
    _, optics = optics_of(LENS, [sighting(BOARD, LENS, view, True, in_hand)] * 2)
    places = [(0, 0), (1, 1), (0, 2), (1, 2)]
    for column, step in enumerate([1e-4] * 2 + [0.5] * 4 + [1e-3] * 2 + [1e-4] * 2):
        ends = []
        for sign in (-1, 1):
            matrix, distortion = LENS.matrix.copy(), LENS.distortion.copy()
            sheet = replace(BOARD)
            if column < 2:
                sheet.__dict__["points"] = BOARD.points * (1 + sign * step * np.eye(3)[column])
            elif column < 6:
                matrix[places[column - 2]] += sign * step
            else:
                distortion[column - 6] += sign * step
            moved = board_pose(sheet, Lens(LENS.size, matrix, distortion), view)
            ends.append(np.linalg.inv(moved) if in_hand else moved)
        (slope,) = displacements(*np.array(ends)[:, None]) / (2 * step)
        assert np.allclose(slope, optics.slopes[0, :, column], rtol=0.01, atol=1e-6)


@PLACES
def test_poses_are_as_sure_as_is_said(in_hand):
    """And what moves corners is a length across the line of sight."""
    cell = Cell(3, in_hand)
    poses, rng = cell.board_poses(cell.postures(300)), np.random.default_rng(3)
    views = [cell.view(pose, NOISE, rng) for pose in poses]
    sightings = [sighting(BOARD, LENS, view, False, in_hand) for view in views]
    measured, optics = optics_of(LENS, sightings)
    gaps = displacements(np.linalg.inv(poses) if in_hand else poses, measured)
    squares = np.einsum("ni,nij,nj->n", gaps, np.linalg.inv(optics.spread), gaps)
    assert squares.mean() == pytest.approx(6, rel=0.1)
    off = optics.moved(gaps)
    per_axis = off.std() ** 2 + off.mean() ** 2  # six of the numbers of noise move the pose
    assert per_axis == pytest.approx(6 * NOISE**2 / len(BOARD.points), rel=0.1)
    assert np.sqrt(np.mean(optics.across(off) ** 2)) == pytest.approx(optics.noise, rel=0.1)
    sideways, away = np.zeros((2, len(poses), 6))
    middle = poses[:, :3, :3] @ [*BOARD.size / 2, 0] + poses[:, :3, 3]
    lines = middle / np.linalg.norm(middle, axis=1)[:, None]
    across = np.cross(lines, [0.0, 1.0, 0.0])
    turns = poses[:, :3, :3].swapaxes(1, 2) if in_hand else np.eye(3)[None]
    for shifts, axes in ((sideways, across), (away, lines)):
        shifts[:, :3] = (turns @ (1e-3 * axes)[..., None])[..., 0]
    assert np.allclose(optics.across(optics.moved(sideways)), 1e-3, rtol=0.2)
    assert optics.across(optics.moved(away)).max() < 5e-4


@PLACES
def test_pictures_are_predicted(in_hand):
    """Those in which the whole board is seen, and those in which it is not."""
    cell = Cell(2, in_hand)
    poses = cell.board_poses(cell.postures(5))
    measured = np.linalg.inv(poses) if in_hand else poses
    slopes, visible = predicted_views(BOARD, LENS, measured, in_hand)
    assert visible.all()
    for found, pose in zip(slopes, poses, strict=True):
        expected = sighting(BOARD, LENS, cell.view(pose), True, in_hand).slopes
        assert np.allclose(found, expected, rtol=1e-3, atol=1e-4 * np.abs(expected).max())
    width, height = BOARD.size
    front = frame([0, 0, 0], [-width / 2, -height / 2, 1.0])
    turns = {"behind": [0, np.pi, 0], "edge on": [0, np.radians(75), 0], "near": [0, 0, 0]}
    hidden = {name: front @ frame(turn, [0, 0, 0]) for name, turn in turns.items()}
    hidden["near"][2, 3] = 0.08  # most of it is outside
    hidden["beside"], hidden["far"] = front.copy(), front.copy()
    hidden["beside"][0, 3] += 2.0
    hidden["far"][2, 3] = 4.0
    hidden["back"] = np.diag([1, 1, -1, 1]) @ front @ np.diag([1, 1, -1, 1])  # of the camera
    boards = np.array([front, *hidden.values()])
    _, visible = predicted_views(BOARD, LENS, np.linalg.inv(boards) if in_hand else boards, in_hand)
    assert dict(zip(["front", *hidden], visible, strict=True)) == {
        "front": True,
        **dict.fromkeys(hidden, False),
    }
