"""Several cameras and boards in one fit: their names, what they are worth, which one slipped."""

import csv
import json
import tomllib
from functools import cache
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

from recalib import RecalibError, calibrate_pictures
from recalib.identification.model import displacements
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.report.summary import pixel_error, summary, verdict
from recalib.vision import Lens, read_lens
from tests.bars.pictures import Draw
from tests.conftest import few_folds
from tests.vision.rendering import LENS, Cell, frame
from tests.vision.sessions import LONGER, PICTURES, SHIFT, SMALL, TURN, beside, write_session

SEED = 3


def on_the_hand(board: bool = False) -> Cell:
    """The same arm with a camera on the hand, which sees a board beside the arm, or another one."""
    cell = Cell(SEED, True, SMALL if board else Cell(SEED).board)
    if board:
        cell.sheet = frame([0, 0, 0], [0.0, 0.25, 0.02]) @ cell.sheet
    return cell


def other_hand() -> Cell:
    """A further camera on the hand, beside the first."""
    cell = Cell(SEED, True, lens=LONGER)
    cell.eye = frame([0, 0, 0], [0.0, -0.08, 0.0]) @ cell.eye
    return cell


# By what is in one fit, its sessions (cell, camera, board), the places that should come out, and
# the names by which commands are given.
SETUPS = {
    "two fixed": (
        [(Cell(SEED), "left", "board"), (beside(SEED), "right", "board")],
        ["camera left", "camera right", "the board"],
        ("the board by camera left", "the board by camera right"),
    ),
    "fixed and hand": (
        [(Cell(SEED), "left", "tool"), (on_the_hand(), "hand", "table")],
        ["camera left", "board table", "board tool", "camera hand"],
        ("board tool by camera left", "camera hand by board table"),
    ),
    "two on the hand": (
        [(on_the_hand(), "hand", "board"), (other_hand(), "other", "board")],
        ["the board", "camera hand", "camera other"],
        ("camera hand", "camera other"),
    ),
    "two boards": (
        [(on_the_hand(), "camera", "near"), (on_the_hand(True), "camera", "far")],
        ["board near", "board far", "the camera"],
        ("the camera by board near", "the camera by board far"),
    ),
}


@few_folds()
def calibrated(*folders):
    return calibrate_pictures("panda.urdf", folders, tool="panda_link8")


@pytest.fixture(scope="module")
def in_one_fit(tmp_path_factory):
    """By the name of a setup, its calibration and the folders of its sessions."""

    @cache
    def make(setup: str):
        folder, (sessions, *_) = tmp_path_factory.mktemp("cell"), SETUPS[setup]
        numbered = enumerate(sessions)
        folders = [write_session(folder / str(number), *session) for number, session in numbered]
        return calibrated(*folders), folders

    return make


def changed(**what) -> Cell:
    """The second of two fixed cameras, with something else."""
    cell = beside(SEED)
    vars(cell).update(what)
    return cell


def true_place(name: str, sessions) -> np.ndarray:
    for cell, camera, board in sessions:
        if name in (f"camera {camera}", "the camera"):
            return cell.eye
        if name in (f"board {board}", "the board"):
            return cell.sheet
    raise KeyError(name)


@pytest.mark.parametrize("setup", SETUPS)
def test_several_cameras_and_boards_are_found_in_one_fit(setup, in_one_fit):
    (sessions, names, targets), (result, _) = SETUPS[setup], in_one_fit(setup)
    draw = Draw(SEED, False)
    assert draw.judge(result.geometry.forward(draw.fresh))[0] < 0.15  # of 4 mm
    assert [place.name for place in result.places] == names
    assert set(result.scales) == {name for name in names if "board" in name}
    assert "Careful" not in verdict(result) and not len(result.doubted)
    assert result.correction.targets == targets
    held_out = result.validation.held_out["in blocks"][result.validation.chosen]
    for sight in range(len(sessions)):
        assert pixel_error(held_out, result.data.observations.targets == sight) < 0.2
    # what stands on one side, relative to the other things there: no gauge moves that
    for side in {place.link for place in result.places}:
        first, *others = (place for place in result.places if place.link == side)
        for other in others:
            found = np.linalg.inv(first.pose) @ other.pose
            truth = [true_place(place.name, sessions) for place in (first, other)]
            off = displacements(found[None], (np.linalg.inv(truth[0]) @ truth[1])[None])[0]
            assert np.linalg.norm(off[:3]) < 4 * (first.deviations[0] + other.deviations[0])
            assert np.linalg.norm(off[:3]) < 2e-3 and np.linalg.norm(off[3:]) < np.radians(0.1)


def test_each_camera_is_written_by_its_name(in_one_fit, tmp_path, capsys):
    folders, out = in_one_fit("two fixed")[1], tmp_path / "calibration"
    arguments = ["panda.urdf", *map(str, folders), "--tool=panda_link8", f"--out={out}"]
    with few_folds():
        assert main(["calibrate", *arguments]) == DONE
    text = capsys.readouterr().out
    assert f"rows {PICTURES + 1} to {2 * PICTURES}: the board by camera right" in text
    assert "corner error in held-out pictures of the board by camera left" in text
    assert "lens_left.yaml, lens_right.yaml" in text and not (out / "lens.yaml").exists()
    for name, lens in (("left", LENS), ("right", LONGER)):
        found = read_lens(out / f"lens_{name}.yaml")
        assert np.allclose(found.matrix, lens.matrix, atol=3)
        assert np.allclose(found.distortion[:2], lens.distortion[:2], atol=0.03)
    hand_eye = tomllib.loads((out / "hand_eye.toml").read_text())
    assert hand_eye["camera_right"]["ros"].endswith("--child-frame-id camera_right")
    assert {"camera_left", "camera_right", "board", "held_out"} < set(hand_eye)
    parameters = json.loads((out / "parameters.json").read_text())
    names = [parameter["name"] for parameter in parameters["parameters"]]
    assert len(set(names)) == len(names) and "focal length along x, 2" in names
    assert [*parameters["base_in_instrument"]] == ["camera left", "camera right"]
    with (out / "frames.csv").open() as stream:
        assert [row["frame"] for row in csv.DictReader(stream)] == [*SETUPS["two fixed"][1]]
    result, _ = in_one_fit("two fixed")
    rows, frames = result.data.observations[result.counted], result.calibration.frames
    nominal = (result.arm.forward(rows.joints) @ frames.targets[0])[:, :3, 3]
    assert np.linalg.norm(result.positions - nominal, axis=1).max() < 0.05
    held_out = result.validation.held_out["in blocks"][result.validation.chosen].residuals
    for row, found in zip(result.counted, result.residuals["after"], strict=True):
        back = frames.bases[rows.targets[row], :3, :3].T
        expected = [back @ part for part in held_out[row].reshape(2, 3)]
        assert np.allclose(found, np.concatenate(expected), atol=1e-12)


def test_a_camera_has_one_lens_in_all_its_folders(in_one_fit, tmp_path):
    """Also if one folder has another lens in its file: it is found anew by all pictures."""
    result, folders = in_one_fit("two boards")
    copies = [Path(copytree(folder, tmp_path / folder.parent.name)) for folder in folders]
    lens, matrices = read_lens(folders[0] / "lens.yaml"), []
    start = Lens(lens.size, lens.matrix + np.diag([30.0, 30.0, 0.0]), lens.distortion)  # px
    (copies[0] / "lens.yaml").write_text(start.as_ros())
    for one in (result, calibrated(*copies)):
        calibration = one.geometry
        optics = calibration.estimate.parameters[calibration.model.optics_columns]
        assert len(optics) == 2 * 2 + 8
        (content,) = one.data.lens_files(optics).values()
        (path := tmp_path / "found.yaml").write_bytes(content)
        matrices.append(read_lens(path).matrix)
    assert np.allclose(matrices[0], LENS.matrix, atol=1)
    assert np.array_equal(*matrices)


@pytest.mark.parametrize(
    ("cell", "slip", "size", "turn", "message"),
    [
        (Cell(SEED, True), ("eye", SHIFT), 1.0, 0.0, "the camera seems to have slipped on the too"),
        (Cell(SEED), ("sheet", TURN), None, 0.2, "the board seems to have slipped on the tool"),
        (Cell(SEED), ("eye", SHIFT), 1.0, 0.0, "the camera or the base seems to have moved"),
        (Cell(SEED, True), ("sheet", SHIFT), 1.0, 0.0, "the board or the base seems to have moved"),
    ],
)
def test_what_slips_in_a_session_is_named_in_the_first_lines(
    cell, slip, size, turn, message, tmp_path
):
    result = calibrated(write_session(tmp_path, cell, slip=slip, pictures=2 * PICTURES))
    fault, *others = result.faults
    assert not others and fault.row == PICTURES
    assert size is None or 1e3 * fault.size == pytest.approx(size, rel=0.25)
    assert np.degrees(fault.turn) == pytest.approx(turn, abs=0.05)
    first = summary(result).splitlines()[1]
    assert f"Careful: between rows {PICTURES} and {PICTURES + 1}, {message}" in first


@pytest.mark.parametrize("both", [False, True], ids=["pictures of one", "pictures of both"])
def test_of_several_cameras_the_one_that_saw_the_slip_is_named(both, tmp_path):
    """A board that slips before two cameras has slipped in both of their sessions."""
    slip = "sheet", SHIFT
    left = write_session(tmp_path / "left", Cell(SEED), "left", slip=slip if both else None)
    right = write_session(tmp_path / "right", beside(SEED), "right", slip=slip)
    (fault,) = calibrated(left, right).faults
    assert (fault.kind, fault.row) == ("slip", PICTURES // 2)
    assert 1e3 * fault.size == pytest.approx(1.0, rel=0.2)
    assert both or fault.sight == 1


def test_a_camera_on_the_hand_that_slips_beside_a_fixed_one_is_named(tmp_path):
    left = write_session(tmp_path / "left", Cell(SEED), "left", "tool")
    hand = write_session(tmp_path / "hand", on_the_hand(), "hand", "table", ("eye", TURN))
    text = verdict(calibrated(left, hand))
    assert f"Careful: in {hand}, between rows 15 and 16, camera hand seems to have slipped" in text


def test_a_board_that_moved_between_two_sessions_is_named(tmp_path):
    moved = changed(sheet=Cell(SEED).sheet @ frame([0, 0, 0], [0.003, 0, 0]))
    left = write_session(tmp_path / "left", Cell(SEED), "left")
    right = write_session(tmp_path / "right", moved, "right")
    text = verdict(calibrated(left, right))
    assert f"{right}, before row 1, the board seems to have slipped on the tool by 3" in text
    assert "try each folder by itself" in text


FAR = frame([0, 0, 1.5], [0.05, 0, 0]) @ Cell(SEED).sheet
NEAR = frame([0, 0, 0], [0.05, 0, 0]) @ Cell(SEED).sheet


@pytest.mark.parametrize(
    ("session", "message"),
    [
        ((beside(SEED), "left"), "it has camera 'left' and board 'board', as .* try: observe wi"),
        ((on_the_hand(), "left", "other"), "it has camera 'left' on the hand, .* next to the arm"),
        ((on_the_hand(), "right"), "its board 'board' differs from that in "),
        ((changed(board=SMALL), "right"), "its board 'board' differs from that in "),
        ((Cell(SEED), "left", "b", None, LENS), "camera 'left' has another lens than in .*/left/"),
        ((changed(sheet=FAR), "right"), "the board by camera right is 825 mm from its place in"),
        ((changed(sheet=NEAR), "right"), "rows 31 to 60: the board by camera right"),
    ],
    ids=["camera and board", "places", "sides", "boards", "lenses", "far", "near"],
)
def test_what_cannot_be_one_cell_is_refused_by_camera_and_board(session, message, tmp_path):
    left = write_session(tmp_path / "left", Cell(SEED), "left")
    with pytest.raises(RecalibError, match=message):
        calibrated(left, write_session(tmp_path / "right", *session))


def test_several_tables_and_known_frames_are_refused(in_one_fit, tmp_path, capsys):
    left, right = in_one_fit("two fixed")[1]
    table, out = str(right / "measurements.csv"), f"--out={tmp_path / 'out'}"
    assert main(["calibrate", "panda.urdf", str(left), table, "--tool=panda_link8", out]) == REFUSED
    assert "it is one of 2 tables; expected: one table, or folders" in capsys.readouterr().err
    (tmp_path / "known.toml").write_text('[target]\nposition = ["0 m", "0 m", "0 m"]\n')
    with pytest.raises(RecalibError, match="an instrument or a target, which is for one camera"):
        calibrate_pictures("panda.urdf", [left, right], tmp_path / "known.toml", "panda_link8")
