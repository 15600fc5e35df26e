"""Hand-eye calibrations by flange poses: what they find, what they refuse, and what they write."""

import re
import tomllib
from collections.abc import Callable
from contextlib import redirect_stderr
from dataclasses import replace
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.errors import InvalidFile, RecalibError
from recalib.identification.checks.moved import moved_ends
from recalib.identification.checks.sequence import JUMP, SLIP
from recalib.identification.hand_eye import calibrate_hand_eye, held_out
from recalib.identification.model import displacements
from recalib.identification.model.hand_eye_model import Sights
from recalib.laboratory.command_line import DONE, NO_BETTER, REFUSED, main
from recalib.laboratory.hand_eye.calibrating import calibrate_poses
from recalib.laboratory.hand_eye.pose_checks import Mistaken, board_size, exchange_in
from recalib.laboratory.hand_eye.pose_table import read_poses
from recalib.vision import Board, board_pose, projected
from tests.vision.hand_eye_cells import HandEyeCell, shown_by, turned
from tests.vision.rendering import Cell

POSES = 20
WAYS = "ros", "ur", "abb", "kuka", "fanuc", "staubli", "ZYZ", "xyx", "YXZ"
SIDES = {True: "hand", False: "fixed"}


def off(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    """m and rad (2,), from a pose to the true one."""
    step = displacements(found[None], true[None])[0]
    return np.array([np.linalg.norm(step[:3]), np.linalg.norm(step[3:])])


def written(poses: np.ndarray, way: str = "ros") -> str:
    """A table of numbers alone."""
    scale = 1.0 if way in ("ros", "ur") else 1e3
    turns = Rotation.from_matrix(poses[:, :3, :3])
    if len(way) == 3 and way.lower().strip("xyz") == "":  # as ZYZ
        numbers = turns.as_euler(way, degrees=True)
    else:
        numbers = {
            "ros": turns.as_quat,
            "ur": turns.as_rotvec,
            "abb": lambda: turns.as_quat(scalar_first=True),
            "kuka": lambda: turns.as_euler("ZYX", degrees=True),
            "fanuc": lambda: turns.as_euler("xyz", degrees=True),
            "staubli": lambda: turns.as_euler("XYZ", degrees=True),
        }[way]()
    rows = np.concatenate([scale * poses[:, :3, 3], numbers], axis=1)
    return "\n".join(" ".join(f"{number:.9g}" for number in row) for row in rows)


@pytest.fixture
def tables(tmp_path, monkeypatch):
    """Write tables of a cell, in a folder of their own; give the true poses of its flange."""
    monkeypatch.chdir(tmp_path)

    def write(cell: HandEyeCell, count: int = POSES, way: str = "ros") -> np.ndarray:
        flange = cell.flange(count)
        (tmp_path / "poses.txt").write_text(written(cell.reported(flange), way))
        (tmp_path / "targets.txt").write_text(written(cell.board_poses(flange)))
        return flange

    return write


def calibrate(*options: str, camera: str = "fixed", way: str = "ros") -> int:
    """By tables."""
    inputs = ["--poses", "poses.txt", "--targets", "targets.txt", "--camera", camera]
    ways = ["--convention", way, "--target-convention", "ros"]
    return main(["calibrate", *inputs, *ways, "--out", "out", *options])


@pytest.mark.parametrize("four_axes", [False, True])
@pytest.mark.parametrize("in_hand", [False, True])
def test_places_and_their_deviations_are_right(in_hand, four_axes):
    """Normalised by what is stated, errors are those of a normal distribution."""
    distances = []
    for seed in range(8):
        cell = HandEyeCell(seed, in_hand, four_axes=four_axes)
        found = calibrate_hand_eye(cell.sights(POSES, 0.0 if four_axes else None))
        step = displacements(found.camera[None], cell.camera[None])[0]
        distances.append(step @ np.linalg.solve(found.covariance[:6, :6], step))
        assert found.accuracy == pytest.approx([cell.position, cell.rotation], rel=0.6)
    assert 6 * 0.4 < np.mean(distances) < 6 * 1.8


@pytest.mark.parametrize("in_hand", [False, True])
def test_deviations_allow_for_errors_that_vary_smoothly_with_the_pose(in_hand):
    """Joints are off by 0.1 deg, a link by 1 mm: as independent errors, 1 of 20 would be within."""
    within = 0
    for seed in range(10):
        cell = Cell(seed, in_hand)
        rng, postures = np.random.default_rng(seed), cell.postures(POSES)
        shifts = np.radians(0.1) * rng.standard_normal(len(cell.arm.joints))
        damages = [EncoderShift(*each) for each in zip(cell.arm.joints, shifts, strict=True)]
        real = apply(cell.arm, [*damages, LinkShortening("panda_link3", 1e-3)]).forward(postures)
        between = np.linalg.inv(real) if in_hand else real
        boards = np.linalg.inv(cell.eye) @ between @ cell.sheet
        boards = boards @ turned(*1e-4 * rng.standard_normal((2, POSES, 3)))
        found = calibrate_hand_eye(Sights(cell.arm.forward(postures), boards, in_hand))
        within += off(found.camera, cell.eye)[0] < 3 * found.deviations(0)[0]
    assert within >= 9


@pytest.mark.parametrize("in_hand", [False, True])
def test_poses_of_other_pictures_count_for_nothing(in_hand):
    sights = (cell := HandEyeCell(1, in_hand)).sights(POSES)
    mixed, rows = sights.flange.copy(), [2, 7, 11, 13]
    mixed[rows] = mixed[[7, 11, 13, 2]]
    found = calibrate_hand_eye(replace(sights, flange=mixed))
    assert found.outliers.tolist() == rows
    assert off(found.camera, cell.camera)[0] < 4 * found.deviations(0)[0]


@given(st.integers(0, 10_000), st.booleans(), st.booleans(), st.sampled_from(["ros", "kuka"]))
@settings(max_examples=6, deadline=None)
def test_a_board_that_looks_the_same_upside_down_may_be(seed, in_hand, inverse, way):
    """Boards of circles or squares, and poses in either direction; mistakes in them are named."""
    board = Board("circles", 4, 10, 0.02) if seed % 2 else Board("chessboard", 9, 7, 0.03)
    cell = HandEyeCell(seed, in_hand, board=board)
    flange = cell.flange(POSES)
    views = [
        replace(view, numbers=view.numbers[::-1]) if cell.rng.random() < 0.5 else view
        for view in cell.views(flange)
    ]
    poses, shown = cell.reported(flange), shown_by(cell, views)
    with TemporaryDirectory() as folder:
        (path := Path(folder, "poses.txt")).write_text(
            written(np.linalg.inv(poses) if inverse else poses, way)
        )
        right, wrong = (
            read_poses(path, way, inverted=way_round) for way_round in (inverse, not inverse)
        )
        files, _ = calibrate_poses(right, shown, in_hand, None, print)
        with pytest.raises(Mistaken, match="--inverse flange"):
            calibrate_poses(wrong, shown, in_hand, None, print)
    assert "outlier" not in files["summary.txt"].decode()
    camera = tomllib.loads(files["hand_eye.toml"].decode())["camera"]
    deviation = float(camera["deviation"][0].split()[0]) / 1e3
    assert off(np.array(camera["matrix"]), cell.camera)[0] < 4 * deviation


@pytest.mark.parametrize("in_hand", [False, True])
def test_a_summary_says_what_an_inexact_lens_costs_and_one_of_another_camera_is_named(
    in_hand, tmp_path
):
    cell = HandEyeCell(3, in_hand, position=0.0, rotation=0.0)
    flange = cell.flange(POSES)
    (path := tmp_path / "poses.txt").write_text(written(flange))
    shown = shown_by(cell, cell.views(flange))

    def found(longer: float) -> tuple[np.ndarray, str]:
        lens = replace(cell.lens, matrix=cell.lens.matrix * [[longer], [longer], [1]])
        pictures = [
            replace(picture, pose=board_pose(cell.board, lens, picture.corners))
            for picture in shown.pictures
        ]
        own = replace(shown, given=lens, pictures=pictures)
        files, _ = calibrate_poses(read_poses(path, "ros"), own, in_hand, None, print)
        camera = tomllib.loads(files["hand_eye.toml"].decode())["camera"]
        return np.array(camera["matrix"]), files["summary.txt"].decode()

    camera, summary = found(1.0)
    stated = float(re.search("moves the camera by another ([0-9.]+) mm", summary)[1]) / 1e3
    assert off(camera, found(1.001)[0])[0] == pytest.approx(stated, rel=0.3)
    with pytest.raises(RecalibError, match="the given lens .* it is not this camera's"):
        found(1.03)


def test_an_exact_arm_leaves_the_noise_of_the_corners():
    cell = HandEyeCell(3, True, position=0.0, rotation=0.0)
    found = calibrate_hand_eye(cell.sights(POSES))
    assert found.accuracy[0] < 5e-5
    assert off(found.camera, cell.camera)[0] < 2e-4


@given(st.integers(0, 100), st.booleans(), st.booleans())
@settings(max_examples=15, deadline=None)
def test_frames_do_not_matter(seed, in_hand, moved_base):
    """A base elsewhere moves what is in the base, and another flange frame what is in that."""
    sights = HandEyeCell(seed, in_hand).sights(10)
    rng = np.random.default_rng(seed)
    step = turned(rng.normal(size=(1, 3)), rng.normal(size=(1, 3)))[0]
    # an error of the flange has the same size in every base, but not about every point of the tool
    flange = step @ sights.flange if moved_base else sights.flange @ turned(rng.normal(size=(1, 3)))
    one, other = calibrate_hand_eye(sights), calibrate_hand_eye(replace(sights, flange=flange))
    predicted = [found.predict(found.sights) for found in (one, other)]
    assert np.abs(displacements(*predicted)).max() < 2e-4
    assert other.accuracy == pytest.approx(one.accuracy, rel=0.1)


@pytest.mark.parametrize(("rows", "count"), [(1, 12), (1, 16), (3, 12), (4, 16)])
@pytest.mark.parametrize("length", [8, 9])  # three rows each may be as many as four are
def test_matrices(rows, count, length, tmp_path):
    rng = np.random.default_rng(5)
    poses = turned(rng.normal(size=(length, 3)), rng.normal(size=(length, 3)))
    lines = poses[:, : count // 4].reshape(-1, count // rows)
    own = (", ".join(f"{number:.9f}" for number in line) for line in lines)
    (path := tmp_path / "poses.txt").write_text("\n".join([str(length), *own]))
    assert read_poses(path).poses == pytest.approx(poses, abs=1e-6)
    if count == 16:
        np.savetxt(path, poses.swapaxes(1, 2).reshape(lines.shape))
        with pytest.raises(InvalidFile, match="is it transposed"):
            read_poses(path)


@pytest.mark.parametrize("in_hand", [False, True])
@pytest.mark.parametrize("way", ["ur", "abb", "kuka"])
def test_a_result_by_tables(in_hand, way, tables, tmp_path):
    tables(cell := HandEyeCell(2, in_hand), way=way)
    assert calibrate(camera=SIDES[in_hand], way=way) == DONE
    result = tomllib.loads((tmp_path / "out/hand_eye.toml").read_text())
    for name, true in (("camera", cell.camera), ("board", cell.target)):
        place = result[name]
        assert place["in"] == ("flange" if (name == "camera") == in_hand else "base")
        matrix = np.array(place["matrix"])
        length, angle = (float(text.split()[0]) for text in place["deviation"])
        assert (off(matrix, true) < 4 * np.array([1e-3 * length, np.radians(angle)])).all()
        same = [Rotation.from_quat(place["quaternion_xyzw"])]
        same += [Rotation.from_rotvec(place["rotation_vector"])]
        same += [Rotation.from_euler("xyz", place["roll_pitch_yaw_deg"], degrees=True)]
        numbers = re.findall(r"[-\d.]+", place["urdf"].partition("rpy")[2])[:3]
        same += [Rotation.from_euler("xyz", [float(number) for number in numbers])]
        for turn in same:
            assert turn.as_matrix() == pytest.approx(matrix[:3, :3], abs=1e-5)
    assert result["robot"]["millimetres"] == pytest.approx(0.5, rel=0.5)


def about(*axis: float) -> Callable:
    """Poses that are turned about one axis of the tool, or all alike."""

    def flange(cell: HandEyeCell) -> np.ndarray:
        flange = cell.flange(POSES)
        turns = np.outer(cell.rng.uniform(-1, 1, POSES), axis)
        flange[:, :3, :3] = flange[0, :3, :3] @ turned(turns)[:, :3, :3]
        return flange

    return flange


class Fault(NamedTuple):
    """What is wrong with poses of a flange, and the message.

    Attributes:
        flange: true poses (n, 4, 4) in a cell.
        change: of the poses that are written.
        options: with which they are read, if written by `way`; by any way if it is empty.
        otherwise: whether the camera is described as on the other side.
    """

    message: str
    flange: Callable = lambda cell: cell.flange(POSES)
    change: Callable = lambda poses: poses
    options: tuple[str, ...] = ()
    way: str = ""
    otherwise: bool = False


def scaled(scale: float) -> Callable:
    return lambda poses: poses * np.array([[1, 1, 1, scale]] * 3 + [[1, 1, 1, 1]])


def tenfold(poses: np.ndarray) -> np.ndarray:
    """Ten times as far from their middle, which may be the base's origin: within 10 m."""
    poses = poses.copy()
    poses[:, :3, 3] -= poses[:, :3, 3].mean(axis=0)
    return scaled(10.0)(poses)


FLIP = np.diag([1.0, -1.0, 1.0, 1.0])
INVERSE = "the flange's poses are those of the base in the flange"
MOVING = "angles about the moving axes z, y, x"
FAULTS = {
    "one axis": Fault("all turns are about one axis", about(0.6, 0.0, 0.8)),
    "alike": Fault("all poses are turned alike", about(0.0, 0.0, 0.0)),
    "too few": Fault("4 poses can be used; expected: at least 6", lambda cell: cell.flange(4)),
    "copies": Fault(
        "5 of its 15 rows are copies of others",
        lambda cell: cell.flange(9)[[0] * 6 + [*range(9)]],
        lambda poses: poses[[0] * 6 + [*range(6, 15)]],
    ),
    "direction": Fault(INVERSE, change=np.linalg.inv),
    "direction of the flange": Fault(INVERSE, options=("--inverse", "flange")),
    "direction of the targets": Fault(
        "the target's are those of the camera in the target", options=("--inverse", "targets")
    ),
    "other axes": Fault(MOVING, options=("--convention", "XYZ"), way="kuka"),
    "fixed axes": Fault(f"{MOVING} (--convention)", options=("--convention", "fanuc"), way="kuka"),
    "the other side": Fault("--camera ", otherwise=True),
    "left-handed": Fault(
        "the poses of one table are of a left-handed frame",
        change=lambda poses: FLIP @ poses @ FLIP,
    ),
    "larger": Fault("larger than by the target's", change=scaled(1.04)),
    "smaller": Fault("smaller than by the target's", change=scaled(0.97)),
    "mm as m": Fault("Is its unit right?", change=scaled(1e3)),
    "m as mm": Fault("likely in metres labelled mm", change=scaled(1e-3)),
    "mm as cm": Fault("likely in millimetres labelled cm", change=tenfold, way="ros"),
}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
@given(st.integers(0, 10_000), st.booleans(), st.sampled_from(WAYS))
@settings(max_examples=2, deadline=None)
def test_what_cannot_be_is_named_in_one_sentence(fault, seed, in_hand, way):
    """In generated cells, by the pose tables of every controller."""
    cell, way = HandEyeCell(seed, in_hand, rotation=np.radians(0.02)), fault.way or way
    flange = fault.flange(cell)
    with TemporaryDirectory() as folder, redirect_stderr(StringIO()) as stderr:
        poses, targets = Path(folder, "poses.txt"), Path(folder, "targets.txt")
        poses.write_text(written(fault.change(cell.reported(flange)), way))
        targets.write_text(written(cell.board_poses(flange)))
        inputs = ["--poses", str(poses), "--convention", way, "--targets", str(targets)]
        where = ["--target-convention", "ros", "--camera", SIDES[in_hand != fault.otherwise]]
        out = ["--out", str(Path(folder, "out"))]
        code = main(["calibrate", *inputs, *where, *out, *fault.options])
    lines = [line for line in stderr.getvalue().splitlines() if not line.startswith("...")]
    expected = fault.message + SIDES[in_hand] * fault.otherwise
    assert code == REFUSED and len(lines) == 1 and expected in lines[0], lines


@pytest.mark.parametrize("in_hand", [False, True])
def test_mistakes_in_the_targets_are_named(in_hand, tables, tmp_path, capsys):
    flange = tables(cell := HandEyeCell(5, in_hand))
    for poses, message in (
        (read_poses("poses.txt", "ros").poses, "those of the board in the camera"),
        (scaled(0.1)(cell.board_poses(flange)), "the target's positions are likely in centimetres"),
    ):
        (tmp_path / "targets.txt").write_text(written(poses))
        assert calibrate(camera=SIDES[in_hand]) == REFUSED
        assert message in capsys.readouterr().err


@pytest.mark.parametrize("seed", range(8))
def test_an_end_that_moves_amid_the_poses_is_named(seed):
    """From five deviations of the noise up to 80 mm; without it nothing is."""
    cell, rng = HandEyeCell(seed, bool(seed % 2)), np.random.default_rng([seed, 45])
    end, count = ("camera", "target")[seed // 2 % 2], int(rng.integers(30, 60))
    first, flange = int(rng.integers(5, count - 4)), cell.flange(count)
    still, reported = cell.board_poses(flange), cell.reported(flange)
    shift = np.exp(rng.uniform(np.log(5 * cell.position), np.log(0.08))) * np.array([[0.6, 0, 0.8]])
    setattr(cell, end, getattr(cell, end) @ turned(0 * shift, shift)[0])
    poses = np.concatenate([still[:first], cell.board_poses(flange)[first:]])
    (fault,), fit = moved_ends(calibrate_hand_eye(Sights(reported, poses, cell.in_hand)))
    assert fault.kind == (SLIP if cell.in_hand == (end == "camera") else JUMP)
    assert abs(fault.row - first) <= 1
    assert fault.size == pytest.approx(np.linalg.norm(shift), rel=0.3)
    assert fit.accuracy[0] == pytest.approx(cell.position, rel=0.5)
    assert not moved_ends(calibrate_hand_eye(Sights(reported, still, cell.in_hand)))[0]


def test_a_camera_that_jumped_is_told_first(tables, tmp_path, capsys):
    cell = HandEyeCell(4, False)
    poses = cell.board_poses(tables(cell, 30))
    poses[12:] = turned(np.zeros((1, 3)), np.array([[0.0, 0.06, 0.0]])) @ poses[12:]
    (tmp_path / "targets.txt").write_text(written(poses))
    assert calibrate() != REFUSED
    words = "between rows 12 and 13, the camera or the base seems to have moved by 60 mm"
    assert capsys.readouterr().out.partition("Careful: ")[2].startswith(words)


@pytest.mark.parametrize("wrong", ["flange targets", "flange", "targets"])
@given(st.integers(0, 10_000), st.booleans())
@settings(max_examples=3, deadline=None)
def test_two_mistakes_that_fit_together_are_doubted(wrong, seed, in_hand):
    """Tables that are inverted, both, or one by a camera on the other side."""
    cell = HandEyeCell(seed, in_hand)
    flange = cell.flange(POSES)
    poses, targets = cell.reported(flange), cell.board_poses(flange)
    if "flange" in wrong:
        poses = np.linalg.inv(poses)
    if "targets" in wrong:
        targets = np.linalg.inv(targets)
    otherwise = " " not in wrong
    found = calibrate_hand_eye(Sights(poses, targets, in_hand != otherwise))
    doubt = exchange_in(found, True)
    assert f"--inverse {wrong}" + f" and --camera {SIDES[in_hand]}" * otherwise in doubt
    assert exchange_in(calibrate_hand_eye(cell.sights(POSES)), False) is None


@pytest.mark.parametrize("in_hand", [False, True])
def test_four_axes_need_a_height(in_hand, tables, tmp_path, capsys):
    tables(cell := HandEyeCell(8, in_hand, four_axes=True))
    assert calibrate(camera=SIDES[in_hand]) == REFUSED
    assert "--height" in capsys.readouterr().err
    height = f"{1e3 * cell.target[2, 3]:.4f} mm +- 0.2 mm"
    assert calibrate("--height", height, camera=SIDES[in_hand]) == DONE
    place = tomllib.loads((tmp_path / "out/hand_eye.toml").read_text())["camera"]
    length = 1e-3 * float(place["deviation"][0].split()[0])
    assert off(np.array(place["matrix"]), cell.camera)[0] < 4 * length


@pytest.mark.parametrize("lean", [0, 5, 20])
@pytest.mark.parametrize("exact", [False, True])
@pytest.mark.parametrize("seed", range(2))
def test_an_axis_that_leans_takes_no_place_away(seed, exact, lean, tables, tmp_path):
    """Nor does a flange that turns about it to the last digit."""
    tables(cell := HandEyeCell(seed, True, four_axes=True))
    base, flange = turned(np.radians([[lean, 0.0, 0.0]]))[0], cell.flange(POSES)
    poses = base @ (flange if exact else cell.reported(flange))
    (tmp_path / "poses.txt").write_text(written(poses))
    (tmp_path / "targets.txt").write_text(written(cell.board_poses(flange)))
    height = f"{1e3 * (base @ cell.target)[2, 3]:.4f} mm"
    assert calibrate("--height", height, camera="hand") == DONE
    place = tomllib.loads((tmp_path / "out/hand_eye.toml").read_text())["camera"]
    assert off(np.array(place["matrix"]), cell.camera)[0] < 0.02


def test_a_height_that_contradicts_the_poses_is_named(tables, capsys):
    tables(HandEyeCell(4, True))
    assert calibrate("--height", "400 mm +- 1 mm", camera="hand") == REFUSED
    assert "without --height; they determine" in capsys.readouterr().err


@pytest.mark.parametrize("in_hand", [False, True])
def test_a_flange_that_only_turns_is_no_board_of_another_size(in_hand):
    cell = HandEyeCell(3, in_hand)
    flange = cell.flange(POSES)
    flange[:, :3, 3] = flange[0, :3, 3]
    sights = Sights(cell.reported(flange), cell.board_poses(flange), in_hand, None)
    assert board_size(calibrate_hand_eye(sights))[1] == np.inf


def test_poses_that_fit_badly_are_no_result(tables, capsys):
    cell = HandEyeCell(9, False, position=8e-3, rotation=np.radians(0.5))
    tables(cell, 40)
    assert calibrate() == NO_BETTER
    assert "Careful: poses and targets do not fit well" in capsys.readouterr().out
    flange = tables(cell := HandEyeCell(9, False), 20)
    flange[:8] = np.roll(flange[:8], 1, axis=0)
    Path("poses.txt").write_text(written(cell.reported(flange)))
    assert calibrate("--out", "other") == NO_BETTER


@pytest.mark.parametrize("in_hand", [False, True])
def test_pictures(in_hand, tmp_path, monkeypatch, capsys):
    """Drawn ones: the errors that are stated are those in further pictures."""
    monkeypatch.chdir(tmp_path)
    cell = HandEyeCell(10, in_hand)
    flange = cell.flange(12)
    (tmp_path / "pictures").mkdir()
    for number, pose in enumerate(cell.board_poses(flange), 1):
        cv2.imwrite(str(tmp_path / f"pictures/{number}.png"), cell.draw(pose))
    (tmp_path / "board.toml").write_text(cell.board.described())
    (tmp_path / "poses.txt").write_text(written(cell.reported(flange), "kuka"))
    inputs = ["--poses", "poses.txt", "--convention", "kuka", "--pictures", "pictures"]
    where = ["--board", "board.toml", "--camera", SIDES[in_hand], "--out", "out"]
    assert main(["calibrate", *inputs, *where]) == DONE
    assert "Corners in held-out pictures are off by" in capsys.readouterr().out
    result = tomllib.loads((tmp_path / "out/hand_eye.toml").read_text())
    length, angle = (float(text.split()[0]) for text in result["camera"]["deviation"])
    stated = np.array([1e-3 * length, np.radians(angle)])
    assert (off(np.array(result["camera"]["matrix"]), cell.camera) < 4 * stated).all()
    held_out = result["held_out"]
    squares = held_out["pixels_of_corner_noise"] ** 2 + held_out["pixels_of_the_robot"] ** 2
    assert held_out["pixels"] ** 2 == pytest.approx(squares, rel=1e-2)
    assert 0.3 < held_out["millimetres"] < 3
    assert (tmp_path / "out/lens.yaml").exists()
    box = [f"{1e2 * low:.1f} cm to {1e2 * high:.1f} cm" for low, high in limits_of(flange)]
    options = ["--count", "6", "--cone", "40 deg", "--box", *box, "--out", "next.csv"]
    assert main(["next", "out", "--poses", *options]) == DONE
    before, after = map(float, re.findall(r"([\d.]+) mm", capsys.readouterr().out))
    assert after < 0.9 * before
    assert before == pytest.approx(length, rel=0.5)
    proposed = read_poses("next.csv").poses
    assert len(proposed) == 6
    for pose in proposed:
        board = cell.board_poses(pose)
        middle = board[:3, :3] @ cell.board.points.mean(axis=0) + board[:3, 3]
        assert board[:3, 2] @ middle / np.linalg.norm(middle) > np.cos(np.radians(45))
        pixels, _ = projected(cell.board.points, cell.lens, board)
        assert np.mean((pixels > 0) & (pixels < cell.lens.size)) > 0.5
        low, high = np.array(limits_of(flange)).T
        assert ((pose[:3, 3] > low - 1e-3) & (pose[:3, 3] < high + 1e-3)).all()


def limits_of(flange: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of x, y and z that a flange took, a little wider."""
    places = flange[:, :3, 3]
    return [*zip(places.min(axis=0) - 0.02, places.max(axis=0) + 0.02, strict=True)]


def test_held_out_residuals_are_those_without_the_pose():
    sights = HandEyeCell(11, True).sights(10)
    residuals = held_out(calibrate_hand_eye(sights))
    for row in range(10):
        without = calibrate_hand_eye(sights[np.setdiff1d(np.arange(10), row)])
        expected = without.residuals(sights[np.array([row])])[0]
        assert np.linalg.norm(residuals[row] - expected) < 0.3 * np.linalg.norm(expected) + 1e-4


def test_with_joints_and_a_urdf_the_arm_is_calibrated(tmp_path, monkeypatch, capsys):
    """By the same table and the same pictures; without the joints it is refused."""
    monkeypatch.chdir(tmp_path)
    cell = Cell(3, True)
    postures = cell.postures(14)
    (tmp_path / "pictures").mkdir()
    poses = written(cell.tool(postures), "kuka").splitlines()
    rows = [["picture", *"xyzabc", *(f"{joint} [rad]" for joint in cell.arm.joints)]]
    for number, (pose, angles) in enumerate(zip(poses, postures, strict=True)):
        shown = cell.picture(cell.board_poses(angles[None])[0])
        cv2.imwrite(str(tmp_path / f"pictures/{number}.png"), shown)
        rows.append([f"{number}.png", *pose.split(), *(f"{angle:.9f}" for angle in angles)])
    (tmp_path / "poses.csv").write_text("\n".join(map(",".join, rows)))
    (tmp_path / "board.toml").write_text(cell.board.described())
    inputs = ["--poses", "poses.csv", "--convention", "kuka", "--pictures", "pictures"]
    where = ["--board", "board.toml", "--camera", "hand"]
    assert main(["calibrate", *inputs, *where, "--out", "hand_eye"]) == DONE
    arm = ["panda.urdf", "--tool", "panda_link8"]
    assert main(["calibrate", *arm, *inputs, *where, "--out", "arm"]) == DONE
    assert (tmp_path / "arm/arm.urdf").exists()
    (tmp_path / "poses.csv").write_text("\n".join(",".join(row[:7]) for row in rows))
    assert main(["calibrate", *arm, *inputs, *where, "--out", "none"]) == REFUSED
    assert "the column of joint 'panda_joint1' is missing" in capsys.readouterr().err
