"""Poses as other programs save them: read as they were written."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile
from recalib.laboratory.hand_eye.pose_table import read_poses
from tests.vision.hand_eye_cells import turned
from tests.vision.test_hand_eye import written

COUNT = 9


def parts(pose: np.ndarray) -> dict[str, dict[str, float]]:
    """As easy_handeye has a pose."""
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
    both = ("translation", "xyz", pose[:3, 3]), ("rotation", "xyzw", turn)
    return {name: dict(zip(axes, map(float, each), strict=True)) for name, axes, each in both}


def vector(pose: np.ndarray) -> list[float]:
    return Rotation.from_matrix(pose[:3, :3]).as_rotvec().tolist()


LAYOUTS = {  # the names of both poses, how each is written, and how it is read
    "MoveIt": ("effector_wrt_world", "object_wrt_sensor", lambda pose: pose.ravel().tolist(), None),
    "easy_handeye": ("robot", "tracking", parts, "ros"),
    "OpenCV": (
        "arm",
        "camera",
        lambda pose: {"rvec": vector(pose), "tvec": pose[:3, 3:].tolist()},
        None,
    ),
    "UR": ("tcpPose", "marker", lambda pose: str([*pose[:3, 3].tolist(), *vector(pose)]), "ur"),
    "matrices": (
        "base2tool",
        "board2cam",
        lambda pose: {"R": pose[:3, :3].tolist(), "t": pose[:3, 3].tolist()},
        None,
    ),
}
TEXTS = {  # a convention, text around its numbers, and text between poses
    "UR": ("ur", "pose = p[{}, {}, {}, {}, {}, {}]", "\n"),
    "KUKA": ("kuka", "DECL POS P1={{X {},Y {},Z {},A {},B {},C {},S 2,T 35,E1 0.0}}", "\n"),
    "Fanuc": (
        "fanuc",
        "P[1]{{\nUF : 0\nX = {} mm,\tY = {} mm,\tZ = {} mm,\n\tW = {} deg, P = {} deg, R = {} deg",
        "\n}};\n",
    ),
    "ABB": (
        "abb",
        "CONST robtarget p1:=[[{},{},{}],[{},{},{},{}],[0,0,1,0],[9E9" + ",9E9" * 5 + "]];",
        "\n",
    ),
    "pictures": ("ros", "1.png {} {} {} {} {} {} {}", "\n"),
    "matrix": ("matrix", "Pose 3:\n{},{},{},{}\n{},{},{},{}\n{},{},{},{}\n0,0,0,1", "\n,,,\n"),
    "Open3D": ("matrix", "1 1 2\n{} {} {} {}\n{} {} {} {}\n{} {} {} {}\n0 0 0 1", "\n"),
    "Matlab": ("matrix", "T1 = [{} {} {} {}; {} {} {} {}; {} {} {} {}; 0 0 0 1];", "\n"),
}
HEADINGS = [
    "x y z qx qy qz qw",
    "time,tx,ty,tz,qx,qy,qz,qw",
    "%time,pose.position.x,pose.position.y,pose.position.z,pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w",
    "pos_x\tpos_y\tpos_z\tquat_x\tquat_y\tquat_z\tquat_w",
    "#t,p_RS_x [m],p_RS_y [m],p_RS_z [m],q_x [],q_y [],q_z [],q_w []",
]
seeds = given(st.integers(0, 10_000))
few = settings(max_examples=5, deadline=None)


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("others"))
        yield patch


def drawn(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return turned(rng.normal(size=(COUNT, 3)), rng.normal(size=(COUNT, 3)))


@pytest.mark.parametrize(("ours", "theirs", "write", "way"), LAYOUTS.values(), ids=LAYOUTS)
@seeds
@few
def test_samples(ours, theirs, write, way, home, seed):
    flange, board = drawn(seed), drawn(seed + 1)
    pairs = zip(map(write, flange), map(write, board), strict=True)
    samples = [{"joints": [0.5] * 6, ours: one, theirs: other} for one, other in pairs]
    samples.insert(seed % COUNT, {ours: write(flange[0]), theirs: None})  # the board is not seen
    Path("samples.yaml").write_text(
        yaml.safe_dump({"samples": samples} if way else samples, sort_keys=False)
    )
    for targets, poses in ((False, flange), (True, board)):
        read = read_poses("samples.yaml", way, targets=targets).poses
        assert read == pytest.approx(poses, abs=1e-9)


@pytest.mark.parametrize("layout", ["ViSP", "OpenCV", "text", "JSON", "HALCON"])
@seeds
@few
def test_a_file_for_each_picture(layout, home, seed):
    """Numbers have gaps, and 10 is after 9."""
    numbers = np.sort(np.random.default_rng(seed).choice(30, COUNT, replace=False))
    poses, folder = drawn(seed), f"{layout}{seed}"
    for number, pose in zip(numbers, poses, strict=True):
        file = Path(folder, f"pose {number}", "pose.yaml")
        file.parent.mkdir(parents=True, exist_ok=True)
        rows = "".join(f"  - [{one:.9g}]\n" for one in (*pose[:3, 3], *vector(pose)))
        if layout == "ViSP":
            file.write_text(f"rows: 6\ncols: 1\ndata: \n{rows}")
        elif layout == "OpenCV":
            head = "%YAML:1.0\n---\nPoseState: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n"
            file.write_text(f"{head}   data: {pose.ravel().tolist()}")
        elif layout == "JSON":
            file.write_text(str({"pose": pose.tolist()}).replace("'", '"'))
        elif layout == "HALCON":
            angles = Rotation.from_matrix(pose[:3, :3]).as_euler("XYZ", degrees=True)
            lines = "# type\nf 0\n# degrees:\nr {} {} {}\n\n# metres:\nt {} {} {}\n"
            file.write_text(lines.format(*angles, *pose[:3, 3]))
        else:
            np.savetxt(file, pose[:3])
    table = read_poses(f"{folder}/*/pose.yaml", "ur" if layout == "ViSP" else None)
    assert table.poses == pytest.approx(poses, abs=1e-7)


@pytest.mark.parametrize(("way", "text", "between"), TEXTS.values(), ids=TEXTS)
@seeds
@few
def test_texts(way, text, between, home, seed):
    poses = drawn(seed)
    rows = poses[:, :3].reshape(-1, 12).tolist()
    rows = rows if way == "matrix" else [line.split() for line in written(poses, way).splitlines()]
    Path("poses.txt").write_text(between.join(text.format(*row) for row in rows))
    assert read_poses("poses.txt", way).poses == pytest.approx(poses, abs=1e-7)


@pytest.mark.parametrize("headings", HEADINGS)
@seeds
@few
def test_headings(headings, home, seed):
    poses, between = drawn(seed), "," if "," in headings else "\t" if "\t" in headings else " "
    rows = [line.split() for line in written(poses).splitlines()]
    ahead = headings.startswith(("t", "%", "#"))
    lines = (between.join([*["1.5"] * ahead, *row]) for row in rows)
    Path("poses.csv").write_text("\n".join([headings, *lines]))
    assert read_poses("poses.csv", unit="m").poses == pytest.approx(poses, abs=1e-7)
    semicolons = "\n".join(";".join(row).replace(".", ",") for row in rows)
    for head in ("", "X;Y;Z;Qx;Qy;Qz;Qw\n"):
        Path("semicolons").write_text(head + semicolons)
        assert read_poses("semicolons", "ros").poses == pytest.approx(poses, abs=1e-7)


@pytest.mark.parametrize("text", ['{"a": [1, 2]}', '{"robot": {"x": 1.5, "joints": [1.5]}}'])
def test_files_without_poses_say_what_has_them(text, home):
    Path("poses.json").write_text(text)
    with pytest.raises(InvalidFile, match="it has no poses; expected: lists of 12 or 16 numbers"):
        read_poses("poses.json")
