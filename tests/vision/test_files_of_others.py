"""Poses as other programs save them: read as they were written."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

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
    "OpenCV": ("arm", "cam", lambda p: {"rvec": vector(p), "tvec": p[:3, 3:].tolist()}, None),
    "UR": ("tcpPose", "marker", lambda p: str([*p[:3, 3].tolist(), *vector(p)]), "ur"),
    "R, t": ("tool", "tag", lambda p: {"R": p[:3, :3].tolist(), "t": p[:3, 3].tolist()}, None),
}
TEXTS = yaml.safe_load(Path(__file__).with_name("texts_of_poses.yaml").read_text())
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
    unseen = {theirs: None} if seed % 2 else {}
    samples.insert(seed % COUNT, {ours: write(flange[0])} | unseen)
    tree = {"samples": samples} if way else samples
    Path("samples.yaml").write_text(yaml.safe_dump(tree, sort_keys=False))
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


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: text["pose"])
@seeds
@few
def test_texts(text, home, seed):
    poses, way, headings = drawn(seed), text["convention"], text.get("headings")
    rows = poses[:, :3].reshape(-1, 12).tolist()
    rows = rows if way == "matrix" else [line.split() for line in written(poses, way).splitlines()]
    whole = "\n".join([*filter(None, [headings]), *(text["pose"].format(*row) for row in rows)])
    Path("poses.txt").write_text(whole.replace(".", ",") if ";Q1" in whole else whole)
    known, unit = (None, "m") if headings and way == "ros" else (way, None)
    assert read_poses("poses.txt", known, unit).poses == pytest.approx(poses, abs=1e-7)
