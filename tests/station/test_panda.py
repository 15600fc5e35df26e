"""The page `panda_in_an_hour` is rehearsed: its commands in their order, on an arm in MuJoCo."""

import re
import sys

import numpy as np
import pytest

from recalib import Observations, load_arm, load_correction
from recalib.identification import solutions
from recalib.laboratory.tables.table import read_table
from tests.conftest import ROOT, run

PAGE = ROOT / "docs" / "panda_in_an_hour.md"
COMMANDS = [
    line
    for block in re.findall(r"```sh\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    for line in re.sub(r"\\\n *", "", block).splitlines()  # also one that goes on in the next
    if not line.startswith("pip ")  # the installation
]
SPAN, FRESH = np.radians(20), 100
HOME = [0, 0.1, 0, -1.9, 0, 3.0, 0.8]  # rad
TRUTH = """
import sys, numpy as np
sys.path.insert(0, "examples/rehearsal")
from panda import BentPanda
np.save("true.npy", BentPanda("fresh").forward(np.load("fresh.npy")))
"""


@pytest.fixture(scope="module")
def rehearsed(tmp_path_factory):
    """A folder in which every command of the page was executed."""
    for needed in ("cv2", "mujoco"):
        pytest.importorskip(needed, reason="needs the extras vision and live")
    folder = tmp_path_factory.mktemp("panda")
    (folder / "examples").symlink_to(ROOT / "examples")
    fresh = HOME + np.random.default_rng(7).uniform(-SPAN, SPAN, (FRESH, len(HOME)))
    np.save(folder / "fresh.npy", fresh)
    for line in [*COMMANDS, f"python -c '{TRUTH}'"]:
        program, _, rest = line.partition(" ")
        interpreter = {"recalib": "-m recalib", "python": ""}[program]
        process = run(f"{sys.executable} {interpreter} {rest}", cwd=folder, shell=True)
        if "EGL" in process.stderr and not (folder / "pictures").exists():
            pytest.skip(f"no pictures here: {process.stderr.splitlines()[-1]}")
        assert process.returncode == 0, f"{line}\n{process.stderr}"
    return folder


@pytest.mark.slow
def test_each_command_works_and_the_arm_is_right_to_a_fifth_of_a_millimetre(rehearsed):
    """After one shift and turn of base and flange, which no camera can tell."""
    fresh, true = (np.load(rehearsed / f"{name}.npy") for name in ("fresh", "true"))

    def mean_error(poses: np.ndarray) -> float:
        ends = next(solutions(poses, Observations(fresh, true)))
        gaps = (ends.base @ poses @ ends.targets[0] - true)[:, :3, 3]
        return 1e3 * np.linalg.norm(gaps, axis=1).mean()

    nominal = mean_error(load_arm("panda.urdf", "panda_link8").forward(fresh))
    found = load_correction(rehearsed / "calibration" / "correction.npz").calibration
    calibrated = mean_error(found.forward(fresh))
    assert calibrated < 0.2 < nominal
    reported = re.findall(r"\| ([\d.]+) mm \|", PAGE.read_text(encoding="utf-8"))
    assert [nominal, calibrated] == pytest.approx([*map(float, reported)], rel=0.3)
    rows = read_table(rehearsed / "measurements.csv").cells["picture"]
    assert len(rows) < 60 and all((rehearsed / name).exists() for name in rows)
    used = (rehearsed / "calibration_observed" / "measurements.csv").read_text().count("\n")
    assert (rehearsed / "commands.csv").read_text().count("\n") == used
