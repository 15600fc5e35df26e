"""Poses as other programs save them, by examples/poses.py: read as they were written."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from recalib.laboratory.hand_eye.pose_table import read_poses
from tests.conftest import ROOT
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


def convert(home: pytest.MonkeyPatch, *arguments: str) -> None:
    home.setattr(sys, "argv", ["poses.py", *arguments])
    runpy.run_path(str(ROOT / "examples" / "poses.py"))


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
    convert(home, "samples.yaml")
    for name, poses in (("poses.txt", flange), ("targets.txt", board)):
        assert read_poses(name, way).poses == pytest.approx(poses, abs=1e-9)


@pytest.mark.parametrize("layout", ["ViSP", "CalLab"])
@seeds
@few
def test_a_file_for_each_picture(layout, home, seed):
    """Numbers have gaps, some pictures have no pose, and 10 is after 9."""
    numbers = np.sort(np.random.default_rng(seed).choice(30, COUNT + 2, replace=False))
    for path in Path().iterdir():
        path.unlink()
    for number in numbers:
        Path(f"camera2-{number:02}.png").touch()
    poses = drawn(seed)
    for number, pose in zip(numbers, poses, strict=False):
        turn = Rotation.from_matrix(pose[:3, :3]).as_rotvec()
        rows = "".join(f"  - [{one:.9g}]\n" for one in (*pose[:3, 3], *turn))
        if layout == "ViSP":
            Path(f"pose_fPe_{number}.yaml").write_text(f"rows: 6\ncols: 1\ndata: \n{rows}")
        else:
            np.savetxt(f"{number}.coords", pose[:3])
    if layout == "ViSP":
        convert(home, "pose_*.yaml", "camera2-*.png", "x,y,z,rx,ry,rz")
    else:
        convert(home, "*.coords", "*.png")
    table = read_poses("poses.csv", "ur" if layout == "ViSP" else None)
    assert table.poses == pytest.approx(poses, abs=1e-7)
    assert table.table.cells["picture"] == [
        f"camera2-{number:02}.png" for number in numbers[:COUNT]
    ]
