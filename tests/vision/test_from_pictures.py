"""From a printed board and pictures to a calibrated arm, by the commands of docs/pictures.md."""

import os
import re
import shutil
import struct
import sys
import tomllib
import zlib
from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import InvalidFile, RecalibError, calibrate_arm, calibrate_pictures, load_arm, vision
from recalib.identification import WAYS
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.pictures import observe as observing
from recalib.laboratory.pictures.observe import observe
from recalib.laboratory.pictures.sessions import Session
from recalib.laboratory.report.folder import hand_eye
from recalib.laboratory.report.summary import verdict
from recalib.vision import Corners, find_corners
from tests.bars.pictures import Draw
from tests.conftest import few_folds
from tests.vision.rendering import LENS, Cell
from tests.vision.sessions import write_joints, write_views

PICTURES = 30


@pytest.fixture(scope="module")
def observed(tmp_path_factory):
    """A folder as observe writes it, of corners that nobody had to look for."""
    folder, draw = tmp_path_factory.mktemp("corners"), Draw(4, in_hand=False)
    return write_views(folder, draw.cell, draw.joints, draw.views), draw


@pytest.fixture(scope="module")
@few_folds()
def calibrated(observed):
    return calibrate_pictures("panda.urdf", [observed[0]], tool="panda_link8")


def test_pixels_are_read_and_weighed(observed, calibrated):
    (folder, draw), result = observed, calibrated
    assert result.data.observations.optics is not None
    assert result.data.instruments == ("the camera",)
    assert abs(result.scales["the board"].factor - 1) < 0.01 and "Careful" not in verdict(result)
    assert draw.judge(result.geometry.forward(draw.fresh))[0] < 0.5
    poses = calibrate_arm("panda.urdf", folder / "measurements.csv", tool="panda_link8")
    assert poses.data.observations.optics is None
    assert draw.judge(poses.geometry.forward(draw.fresh))[0] > 0.5


@pytest.mark.parametrize(
    ("file", "change", "message"),
    [
        ("setup.toml", ('"fixed"', '"roof"'), "camera or lens_from_pictures is not as observe"),
        ("setup.toml", ('"camera"', '"two words"'), "camera_name or board_name is not as"),
        ("corners.csv", ("u [px]", "w [px]"), "unknown column 'w'"),
        ("corners.csv", ("\n003.png,", "\n99,"), "003.png has 0 corners"),
        ("corners.csv", ("\n003.png,7,", "\n3,70,"), "a corner is not among the board's 24"),
        ("corners.csv", ("\n003.png,7,", "\n003.png,6,"), "003.png has a corner twice"),
        ("corners.csv", ("\n003.png,7,", "\n003.png,7,1e300,1\nx,7,"), "expected: up to 100000 p"),
        ("measurements.csv", ("picture,", "a picture,"), "unknown column 'a picture'"),
    ],
)
def test_a_folder_that_was_changed_is_refused(file, change, message, observed, tmp_path, capsys):
    shutil.copytree(observed[0], tmp_path, dirs_exist_ok=True)
    (tmp_path / file).write_text((tmp_path / file).read_text().replace(*change))
    arguments = [str(tmp_path), "--tool=panda_link8", f"--out={tmp_path / 'new'}"]
    assert main(["calibrate", "panda.urdf", *arguments]) == REFUSED
    assert message in capsys.readouterr().err


WRONG_CORNERS = {  # what becomes of the pixels (c, 2) of one picture, or of all
    "mirrored": lambda pixels, random: [1279, 0] + [-1, 1] * pixels,
    "shuffled": lambda pixels, random: random.permutation(pixels),
    "anywhere": lambda pixels, random: random.uniform(0, 960, pixels.shape),
    "in one place": lambda pixels, random: 500 + 1e-4 * random.standard_normal(pixels.shape),
    "tiny": lambda pixels, random: 1e-3 * pixels,
    "flat": lambda pixels, random: pixels * [1, 0.01] + random.standard_normal(pixels.shape),
    "u and v exchanged": lambda pixels, random: pixels[:, ::-1],
    "far outside": lambda pixels, random: 10 * pixels,
    "one elsewhere": lambda pixels, random: np.vstack([pixels[1] - 200, pixels[1:]]),
}


@pytest.mark.parametrize("every", [True, False], ids=["all pictures", "one picture"])
@pytest.mark.parametrize("wrong", WRONG_CORNERS)
def test_corners_that_no_board_can_have_are_refused(wrong, every, observed, tmp_path):
    shutil.copytree(observed[0], tmp_path, dirs_exist_ok=True)
    path, random = tmp_path / "corners.csv", np.random.default_rng(0)
    header, *rows = [row.split(",") for row in path.read_text().splitlines()]
    for name in dict.fromkeys(row[0] for row in rows) if every else ["003.png"]:
        own = [row for row in rows if row[0] == name]
        pixels = np.array([row[2:] for row in own], dtype=float)
        for row, (u, v) in zip(own, WRONG_CORNERS[wrong](pixels, random), strict=True):
            row[2:] = f"{u:.4f}", f"{v:.4f}"
    path.write_text("\n".join(",".join(row) for row in [header, *rows]))
    with pytest.raises(InvalidFile, match=r"can have them|expected: inside|on a line") as error:
        Session.read(tmp_path, load_arm("panda.urdf", "panda_link8"))
    assert every or "003.png" in str(error.value)


def test_rows_may_be_taken_out_and_moved(observed, tmp_path):
    """Their corners are those of their pictures."""
    shutil.copytree(observed[0], tmp_path, dirs_exist_ok=True)
    path = tmp_path / "measurements.csv"
    header, first, *others = path.read_text().splitlines()
    path.write_text("\n".join([header, *others[:0:-1], first]))
    arm = load_arm("panda.urdf", "panda_link8")
    copy, whole = (Session.read(folder, arm) for folder in (tmp_path, observed[0]))
    rows = [*range(PICTURES - 1, 1, -1), 0]
    assert np.array_equal(copy.rows.joints, whole.rows.joints[rows])
    for row, view in zip(rows, copy.views, strict=True):
        assert np.array_equal(view.pixels, whole.views[row].pixels)


def test_a_board_of_another_size_is_doubted(observed, tmp_path):
    shutil.copytree(observed[0], tmp_path, dirs_exist_ok=True)
    text = (tmp_path / "setup.toml").read_text()
    text = text.replace('"36 mm"', '"33 mm"').replace('"27 mm"', '"24.75 mm"')
    (tmp_path / "setup.toml").write_text(text)
    result = calibrate_pictures("panda.urdf", [tmp_path], tool="panda_link8")
    assert result.scales["the board"].factor == pytest.approx(36 / 33, abs=0.01)
    assert re.search(r"the board is (8|9)\.\d percent larger than its description", verdict(result))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("j [rad]\n0\n", "column 'picture' is missing"),
        ("picture,j [rad]\na.png,0\na.png,1\n", "'a.png' is in more than one row"),
        ("picture,j [rad]\na.png,0\n", "none of the pictures in joints.csv can be read"),
        ("picture,j [rad]\ngrey.png,0\n", "0 of 1 pictures can be used; .* it shows 0 markers"),
        ("picture,j [deg]\ngrey.png,abc\n", "row 1 of column 'j' is 'abc'; expected: a number"),
    ],
)
def test_what_cannot_be_observed_is_refused(table, message, tmp_path, capsys):
    (tmp_path / "joints.csv").write_text(table)
    main(["board", "--out", str(tmp_path / "board")])
    cv2.imwrite(str(tmp_path / "grey.png"), np.full((480, 640), 90, np.uint8))
    arguments = [str(tmp_path), str(tmp_path / "joints.csv"), f"--out={tmp_path / 'observed'}"]
    board = f"--board={tmp_path / 'board' / 'board.toml'}"
    assert main(["observe", *arguments, board]) == REFUSED
    assert re.search(message, capsys.readouterr().err)


def test_a_lens_of_another_camera_leaves_more_than_one_of_these_pictures(take_pictures):
    _, _, (*files, lens) = take_pictures(12)
    lens.write_text(LENS.as_ros())
    result = observe(*files, lens)
    own = re.search(r"lens as given \(one from these .* ([\d.]+) px\)", result.summary())[1]
    assert 0.9 < result.error / float(own) < 1.1 and "Careful" not in result.summary()
    lens.write_text(replace(LENS, distortion=0 * LENS.distortion).as_ros())
    assert "Careful: the given lens has focal lengths of 1105.0" in observe(*files, lens).summary()
    for other in (
        replace(LENS, matrix=LENS.matrix * [[1.1], [1.1], [1.0]]),
        replace(LENS, matrix=LENS.matrix * [[0.4], [0.4], [1.0]]),
        replace(LENS, distortion=np.array([0, 0, 0, 0, 0, 1e6, 0, 0])),
    ):
        lens.write_text(other.as_ros())
        with pytest.raises(RecalibError, match="it is not this camera's; try: without --lens"):
            observe(*files, lens)


def test_without_opencv_a_sentence_says_what_to_install(monkeypatch, tmp_path, capsys):
    monkeypatch.delitem(sys.modules, "recalib.vision.boards")
    monkeypatch.delitem(vars(vision), "printable", raising=False)
    monkeypatch.setitem(sys.modules, "cv2", None)
    assert main(["board", "--out", str(tmp_path / "board")]) == REFUSED
    assert "cv2 is missing; try: pip install" in capsys.readouterr().err


@pytest.fixture
def take_pictures(tmp_path, monkeypatch):
    """Write the files that observe needs, and replace the search for corners in the pictures."""

    def pictures(count: int) -> tuple:
        cell = Cell(5)
        joints, random = cell.postures(count), np.random.default_rng(6)
        views = []
        for number, pose in enumerate(cell.board_poses(joints)):
            views.append(cell.view(pose, 0.1 + 0.02 * number, random))
            picture = np.full((*LENS.size[::-1],), number, np.uint8)
            cv2.imwrite(str(tmp_path / f"{number:03}.png"), picture)
        write_joints(tmp_path / "joints.csv", cell, joints)
        (tmp_path / "board.toml").write_text(cell.board.described())
        (tmp_path / "lens.yaml").write_text(LENS.as_ros())
        monkeypatch.setattr(
            "recalib.laboratory.pictures.observe.find_corners",
            lambda board, grey: views[grey[0, 0]],
        )
        files = (tmp_path / name for name in ("joints.csv", "board.toml", "lens.yaml"))
        return cell, views, (tmp_path, *files)

    return pictures


def test_a_camera_has_its_name_and_a_board_that_of_its_file(take_pictures, tmp_path, capsys):
    _, _, (folder, joints, board, lens) = take_pictures(12)
    renamed = board.rename(board.with_name("on the table.toml"))
    files = [str(folder), str(joints), f"--board={renamed}", f"--lens={lens}"]
    out = f"--out={tmp_path / 'observed'}"
    assert main(["observe", *files, "--name=left-1", out]) == DONE
    setup = tomllib.loads((tmp_path / "observed" / "setup.toml").read_text())
    assert (setup["camera_name"], setup["board_name"]) == ("left-1", "on_the_table")
    page = (tmp_path / "observed" / "page.html").read_text()
    assert page.count("<img") == 12 and 'src="http' not in page
    assert main(["observe", *files, "--name=left 1", f"{out}_again"]) == REFUSED
    assert "--name is 'left 1'; expected: letters, digits, _ and -" in capsys.readouterr().err


def test_reprojection_errors_are_root_mean_squares(take_pictures):
    cell, views, files = take_pictures(12)
    files[1].write_text(files[1].read_text().replace("000.png", "./000.png"))
    result = observe(*files)
    assert len(result.used) == 12 and result.given and not result.unlisted
    squares = []
    for picture, view in zip(result.pictures, views, strict=True):
        corners = picture.corners
        assert np.array_equal(corners.pixels, view.pixels[corners.numbers])
        off = corners.pixels - cell.project(picture.pose)[corners.numbers]
        squares.append((off**2).sum(axis=1).mean())
        assert picture.error == pytest.approx(np.sqrt(squares[-1]), rel=1e-6)
    assert result.error == pytest.approx(np.sqrt(np.mean(squares) / 2), rel=1e-6)


def test_a_picture_of_which_few_corners_fit_is_refused(take_pictures):
    """The rest would be too few for `recalib calibrate`."""
    _, views, files = take_pictures(12)
    few = [0, 2, 5, 9, 12, 15, 20, 23]
    pixels = views[4].pixels[few]
    pixels[3] += 2.0
    views[4] = Corners(views[4].numbers[few], pixels, 1.0)
    picture = observe(*files).pictures[4]
    assert re.search(r"[4-7] of 8 corners fit; expected: at least 8", picture.reason)
    for number in {*range(12)} - {4}:
        pixels = views[number].pixels[few]
        pixels[3] += 2.0
        views[number] = Corners(views[number].numbers[few], pixels, 1.0)
    with pytest.raises(RecalibError, match="of 12 pictures can be used; .* of 8 corners fit"):
        observe(*files)


def png(width: int, height: int, rows: int | None = None) -> bytes:
    """A black picture, which takes little room and may be huge when it is read."""
    squeeze = zlib.compressobj(9)
    content = [squeeze.compress(bytes(1 + width)) for _ in range(rows or height)]
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    body = b"".join([*content, squeeze.flush()])
    chunks = [
        struct.pack(">I", len(part)) + name + part + struct.pack(">I", zlib.crc32(name + part))
        for name, part in ((b"IHDR", head), (b"IDAT", body), (b"IEND", b""))
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


NO_PICTURES = {  # by name: what is in the file, and why it is refused
    "point.png": (png(1, 1), "1 x 1 pixels; expected: at least 32 x 32"),
    "line.png": (png(1280, 1), "1280 x 1 pixels; expected: at least 32 x 32"),
    "column.png": (png(1, 700), "1 x 700 pixels; expected: at least 32 x 32"),
    "strip.png": (png(20000, 40), "20000 x 40 pixels; expected, as by the lens: 1280 x"),
    "large.png": (png(12000, 9000, 1), "12000 x 9000 pixels; expected: .* 100 million in all"),
    "huge.png": (png(30000, 30000, 1), "it is too large"),
    "broken.png": (png(40, 40)[:50], "it is not a picture"),
    "empty.png": (b"", "it is not a picture"),
    "nu\0l.png": (None, "there is no such file"),
    300 * "x" + ".png": (None, "it is not a picture"),
    "..": (None, "there is no such file"),
    "pipe.png": (None, "there is no such file"),
}


def test_what_is_no_picture_is_refused_in_a_sentence(take_pictures, monkeypatch):
    *_, (folder, joints, board, lens) = take_pictures(11)
    (folder / "spare.png").write_bytes((folder / "000.png").read_bytes())
    twice = (folder / "000.png").read_bytes(), "it is the same picture as 000.png"
    seen = NO_PICTURES | {"copy.png": twice}
    row = joints.read_text().splitlines()[-1].partition(",")[2]
    with joints.open("a") as table:
        for name, (content, _) in seen.items():
            table.write(f"{name},{row}\n")
            if content is not None:
                (folder / name).write_bytes(content)
    os.mkfifo(folder / "pipe.png")  # whoever opens it waits for ever
    known = observing.find_corners
    find = lambda board, grey: (known if grey.shape == (960, 1280) else find_corners)(board, grey)  # noqa: E731
    monkeypatch.setattr(observing, "find_corners", find)
    result = observe(folder, joints, board, lens)
    assert len(result.used) == 11
    text = result.summary()
    assert text.startswith(f"11 of {11 + len(seen)} pictures are used; reprojection")
    assert "not in joints.csv: spare.png\n" in text
    for picture, (_, reason) in zip(result.pictures[11:], seen.values(), strict=True):
        assert re.search(reason, picture.reason), picture.name
        assert f"(row {picture.row})" in text and picture.reason in text


def published(command: str) -> np.ndarray:
    """The pose (4, 4) [m] that a command of ROS 2 publishes, as tf2 reads its options."""
    words = command.split()
    given = {words[at]: words[at + 1] for at in range(4, len(words), 2)}
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_quat([float(given[f"--q{part}"]) for part in "xyzw"]).as_matrix()
    pose[:3, 3] = [float(given[f"--{axis}"]) for axis in "xyz"]
    return pose


def test_places_are_written_as_they_are_published(calibrated):
    """And the arm that is taken as right has its own."""
    written = tomllib.loads(hand_eye(calibrated))
    for place in calibrated.places:
        name = place.name.removeprefix("the ")
        assert written[name]["in"] == place.link
        assert np.allclose(published(written[name]["ros"]), place.pose, atol=1e-6)
        for table in (written[name], written["arm_as_right"][name]):
            pose = published(table["ros"])
            numbers = [float(text.split()[0]) for text in table["position"]]
            assert numbers == pytest.approx(1e3 * pose[:3, 3], abs=1e-3)
            angles = [float(text.split()[0]) for text in table["roll_pitch_yaw"]]
            turn = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
            assert np.allclose(turn, pose[:3, :3], atol=1e-5)
    own, as_right = written["held_out"], written["arm_as_right"]["held_out"]
    validation, optics = calibrated.validation, calibrated.data.observations.optics
    for name in WAYS:
        judged = validation.judged(name)
        residuals = validation.held_out[name][validation.chosen].residuals[judged]
        moved = np.einsum("nij,nj->ni", optics.pixels[judged], residuals)
        pixels = np.linalg.norm(moved, axis=1).mean()
        assert own[name]["pixels"] == pytest.approx(pixels, rel=1e-3)
        millimetres = 1e3 * validation.mean_error(name, validation.chosen)
        assert own[name]["millimetres"] == pytest.approx(millimetres, rel=1e-3)
        assert as_right[name]["pixels"] > 4 * pixels  # its lens is found anew, which helps it
