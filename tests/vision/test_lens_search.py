"""The lens by pictures: whatever it is, it is found; and it is blamed if it is another."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import calibrate_pictures, load_arm
from recalib.laboratory.pictures.sessions import read_folders
from recalib.laboratory.report.summary import verdict
from recalib.laboratory.tables.description import Description
from recalib.vision import (
    Corners,
    Lens,
    find_corners,
    find_lens,
    lens_search,
    printable,
    projected,
    read_lens,
)
from recalib.vision.detection import are_on_a_line
from recalib.vision.lens_search import reprojection_error
from tests.conftest import few_folds
from tests.vision.rendering import BOARD, LENS, Cell
from tests.vision.sessions import write_views

SIZE, NOISE = (1280, 960), 0.1  # px


def matrix(focal: float, x: float = 640.0, y: float = 480.0) -> np.ndarray:
    return np.array([[focal, 0, x], [0, focal, y], [0, 0, 1]])


RATIONAL = [0.5, -0.1, 1e-4, 2e-4, -0.005, 0.85, -0.02, -0.01]
LENSES = {
    "straight": Lens(SIZE, matrix(900), np.zeros(4)),
    "ordinary": LENS,
    "third order": Lens(SIZE, matrix(800), np.array([-0.32, 0.14, 3e-4, -2e-4, -0.03])),
    "rational": Lens(SIZE, matrix(600), np.array(RATIONAL)),
    "fisheye": Lens(SIZE, matrix(330), np.array([0.05, -0.02, 0.005, -0.001]), True),
    "cropped off centre": Lens(SIZE, matrix(1100, 300, 900), LENS.distortion),
}


def views_of(lens: Lens, count: int = 25, seed: int = 0) -> list[tuple]:
    """Corners of a board anywhere in the picture, tilted by up to 40 degrees."""
    rng, views = np.random.default_rng(seed), []
    while len(views) < count:
        tilt = rng.uniform(0, 1.2) if lens.fisheye else np.arctan(0.6 * rng.uniform())
        ray = Rotation.from_euler("zy", [rng.uniform(0, 2 * np.pi), tilt]).as_matrix()
        facing = ray @ Rotation.from_euler("z", rng.uniform(0, 2 * np.pi)).as_matrix()
        pose = np.eye(4)
        pose[:3, :3] = facing @ Rotation.from_rotvec(rng.uniform(-0.6, 0.6, 3)).as_matrix()
        pose[:3, 3] = rng.uniform(0.35, 0.9) * ray[:, 2] - pose[:3, :2] @ BOARD.size / 2
        if ((BOARD.points @ pose[:3, :3].T + pose[:3, 3])[:, 2] < 0.02).any():
            continue
        pixels, _ = projected(BOARD.points, lens, pose)
        (visible,) = np.nonzero(((pixels > 5) & (pixels < np.array(SIZE) - 5)).all(axis=1))
        if len(visible) > 12:
            noisy = pixels[visible] + NOISE * rng.standard_normal((len(visible), 2))
            views.append((BOARD, Corners(visible, noisy, 1.0)))
    return views


@pytest.mark.parametrize("name", LENSES)
def test_the_model_of_a_lens_is_chosen_by_what_it_leaves(name):
    """It predicts where fresh corners are; a model that is richer than needed is not taken."""
    lens = LENSES[name]
    found = find_lens(views_of(lens), SIZE)
    assert found.converged and found.error == pytest.approx(NOISE, rel=0.1)
    assert len(found.lens.distortion) <= len(lens.distortion)
    assert reprojection_error(views_of(lens, 10, 1), found.lens) < 1.1 * NOISE
    if lens.fisheye or len(lens.distortion) == 4:
        assert found.lens.fisheye == lens.fisheye


@pytest.mark.parametrize("name", LENSES)
def test_a_lens_is_read_as_it_is_written(name, tmp_path):
    lens = LENSES[name]
    (tmp_path / "lens.yaml").write_text(lens.as_ros())
    again = read_lens(tmp_path / "lens.yaml")
    assert (again.size, again.fisheye) == (lens.size, lens.fisheye)
    assert np.allclose(again.matrix, lens.matrix) and np.allclose(again.distortion, lens.distortion)


def test_a_search_that_does_not_come_to_its_end_says_so(monkeypatch):
    monkeypatch.setattr(lens_search, "STEPS", 1)
    assert not find_lens(views_of(LENSES["third order"]), SIZE).converged


@pytest.fixture
def wide(tmp_path):
    """A camera whose lens is not mild, and a function that makes a folder of its pictures."""
    cell = Cell(2, lens=replace(LENS, distortion=np.array([-0.5, 0.45, 0.0, 0.0, -0.35])))
    joints = cell.postures(30)
    views = [cell.view(pose, NOISE) for pose in cell.board_poses(joints)]

    def observed(given: Lens | None = None):
        name = "unknown" if given is None else f"{given.distortion[-1]:.3f}"
        return write_views(tmp_path / name, cell, joints, views, given)

    return cell, observed


def test_a_lens_that_is_not_mild_is_found_and_the_arm_is_not_blamed(wide):
    _, observed = wide
    folder = observed()
    with few_folds():
        result = calibrate_pictures("panda.urdf", [folder], tool="panda_link8")
    assert "Careful" not in verdict(result) and result.worthwhile
    assert result.validation.mean_error("at random", result.validation.chosen) < 2e-4
    # a folder of an earlier search, which took another lens, is searched again
    (folder / "lens.yaml").write_text(LENS.as_ros())
    again = read_folders([folder], result.arm, Description())
    first, optics = result.data, np.zeros(len(again.observations.optics.kinds))
    assert again.lens_files(optics) == first.lens_files(optics)


def test_a_given_lens_that_leaves_much_more_than_another_is_doubted_before_the_arm(wide):
    (cell, observed), arm = wide, load_arm("panda.urdf", "panda_link8")
    wrong = replace(cell.lens, distortion=cell.lens.distortion * [1, 1, 1, 1, 0.9])
    (doubt,) = read_folders([observed(wrong)], arm, Description()).doubts
    assert doubt.startswith("the given lens has focal lengths of")
    assert "and a reprojection error of" in doubt
    assert not read_folders([observed(cell.lens)], arm, Description()).doubts


def test_a_picture_out_of_focus_shows_the_markers_that_others_lead_to():
    cell = Cell(3)
    found = []
    for pose in cell.board_poses(cell.postures(8)):
        try:
            view = find_corners(BOARD, cell.picture(pose, blur=1.8))
        except Exception:
            continue
        gaps = np.linalg.norm(view.pixels - cell.project(pose)[view.numbers], axis=1)
        found += gaps.tolist()
    assert len(found) > 40 and np.median(found) < 0.2  # px; none without them


def test_corners_on_a_line_tell_no_pose():
    board = printable(12, 4, 0.03)
    assert are_on_a_line(board, np.arange(11)) and not are_on_a_line(board, np.arange(12))
