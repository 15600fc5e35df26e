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

COUNT = 9


def parts(pose: np.ndarray) -> dict[str, dict[str, float]]:
    """As easy_handeye has a pose."""
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
    both = ("translation", "xyz", pose[:3, 3]), ("rotation", "xyzw", turn)
    return {name: dict(zip(axes, map(float, each), strict=True)) for name, axes, each in both}


LAYOUTS = {  # the names of both poses, how each is written, and how it is read
    "MoveIt": ("effector_wrt_world", "object_wrt_sensor", lambda pose: pose.ravel().tolist(), None),
    "easy_handeye": ("robot", "tracking", parts, "ros"),
}
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
    samples = [{ours: one, theirs: other} for one, other in pairs]
    Path("samples.yaml").write_text(
        yaml.safe_dump({"samples": samples} if way else samples, sort_keys=False)
    )
    for targets, poses in ((False, flange), (True, board)):
        read = read_poses("samples.yaml", targets=targets).poses
        assert read == pytest.approx(poses, abs=1e-9)


@pytest.mark.parametrize("layout", ["ViSP", "OpenCV", "text", "JSON"])
@seeds
@few
def test_a_file_for_each_picture(layout, home, seed):
    """Numbers have gaps, and 10 is after 9."""
    numbers = np.sort(np.random.default_rng(seed).choice(30, COUNT, replace=False))
    for path in Path().iterdir():
        path.unlink()
    poses = drawn(seed)
    for number, pose in zip(numbers, poses, strict=True):
        file = Path(f"pose_{number}.yaml")
        turn = Rotation.from_matrix(pose[:3, :3]).as_rotvec()
        rows = "".join(f"  - [{one:.9g}]\n" for one in (*pose[:3, 3], *turn))
        if layout == "ViSP":
            file.write_text(f"rows: 6\ncols: 1\ndata: \n{rows}")
        elif layout == "OpenCV":
            head = "%YAML:1.0\n---\nPoseState: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n"
            file.write_text(f"{head}   data: {pose.ravel().tolist()}")
        elif layout == "JSON":
            file.write_text(str({"pose": pose.tolist()}).replace("'", '"'))
        else:
            np.savetxt(file, pose[:3])
    table = read_poses("pose_*.yaml", "ur" if layout == "ViSP" else None)
    assert table.poses == pytest.approx(poses, abs=1e-7)


def test_a_table_of_other_separators_and_brackets(home):
    poses = drawn(3)
    rows = np.concatenate(
        [1e3 * poses[:, :3, 3], Rotation.from_matrix(poses[:, :3, :3]).as_quat(scalar_first=True)],
        axis=1,
    )
    Path("robtargets").write_text(
        "\n".join(
            f"[{row[:3].tolist()},{row[3:].tolist()},[0,0,1,0],[9E9" + ",9E9" * 5 + "]]"
            for row in rows
        )
    )
    semicolons = "\n".join(";".join(map(str, row)).replace(".", ",") for row in rows)
    Path("semicolons").write_text(f"X;Y;Z;Q1;Q2;Q3;Q4\n{semicolons}")
    for name in ("robtargets", "semicolons"):
        assert read_poses(name, "abb").poses == pytest.approx(poses, abs=1e-9)
