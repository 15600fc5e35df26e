"""A small arm that is bent, measurements of it, and its calibration."""

import numpy as np
import pandas as pd
import pytest

from recalib import Calibrated, Chain, calibrate_arm, load_arm
from recalib.laboratory.command_line import DONE, main
from tests.arms import urdf
from tests.conftest import few_folds

NOISE = 5e-5  # m
ROWS = 30
OFFSETS = np.array([0.02, -0.015, 0.01])  # rad
ARM = urdf(
    ("swing", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0.1"),
    ("elbow", "revolute", "0 1 0", "0.4 0 0"),
    ("flange", "fixed", "0 0 1", "0.35 0 0.02"),
)
RANGE = np.array([0.9, 0.5, 0.6])  # rad about the middle
MIDDLE = np.array([0.0, -0.7, 1.1])
quick = pytest.fixture(autouse=True)(few_folds.__wrapped__)


def true_positions(arm, joints: np.ndarray) -> np.ndarray:
    """Where the bent arm goes [m]."""
    return arm.forward(joints + OFFSETS)[:, :3, 3]


def measured(arm, joints: np.ndarray, seed: int = 4) -> np.ndarray:
    """The same as an instrument in the arm's base sees it."""
    noise = np.random.default_rng(seed).standard_normal((len(joints), 3))
    return true_positions(arm, joints) + NOISE * noise


def to_instrument(positions: np.ndarray) -> np.ndarray:
    """From the arm's base to where the camera stands."""
    return positions @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [1.0, 0.5, -0.2]


def write(path, columns: dict[str, np.ndarray]) -> None:
    pd.DataFrame(columns).to_csv(path, index=False)


def in_degrees(arm, joints: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{joint} [deg]": np.degrees(joints[:, i]) for i, joint in enumerate(arm.joints)}


def in_millimetres(positions: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{axis} [mm]": 1e3 * positions[:, i] for i, axis in enumerate("xyz")}


def table(arm, joints: np.ndarray, positions: np.ndarray) -> dict[str, np.ndarray]:
    return in_degrees(arm, joints) | in_millimetres(positions)


def calibrated_by(arm, folder, joints, positions, *description) -> Calibrated:
    """The calibration by a table of these rows."""
    write(folder / "rows.csv", table(arm, joints, positions))
    return calibrate_arm(folder / "arm.urdf", folder / "rows.csv", *description)


def angles_in(columns: pd.DataFrame, arm) -> np.ndarray:
    """Joint angles (n, 3) [rad] of a table."""
    return np.radians([columns[f"{joint} [deg]"] for joint in arm.joints]).T


def postures(seed: int, count: int = ROWS, part: float = 1.0) -> np.ndarray:
    """Joint angles (count, 3) [rad] in this part of the measured ranges."""
    return MIDDLE + part * RANGE * np.random.default_rng(seed).uniform(-1, 1, (count, 3))


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("laboratory")
    (folder / "arm.urdf").write_text(ARM)
    return folder


@pytest.fixture(scope="session")
def arm(folder):
    return load_arm(folder / "arm.urdf")


@pytest.fixture(scope="session")
def calibrated(arm, folder):
    """By the command line; neither the camera's place nor the target's on the tool is known."""
    joints = postures(8)
    positions = to_instrument(measured(arm, joints, 8))
    write(folder / "measurements.csv", table(arm, joints, positions))
    files = folder / "arm.urdf", folder / "measurements.csv"
    out = folder / "calibration"
    assert main(["calibrate", *map(str, files), "--recording", f"--out={out}"]) == DONE
    return out


@pytest.fixture(scope="session")
def in_sockets(folder):
    """A table of a seven-jointed arm of which one joint is off, in two sockets."""
    arm = load_arm("panda.urdf", "panda_hand_tcp")
    random = np.random.default_rng(15)
    joints = np.array([0, 0.2, 0, -2, 0, 2.2, 0.8]) + random.uniform(-0.6, 0.6, (40, 7))
    names = ["left", "right"] * 20
    centres = {"left": [0.45, -0.15, 0.3], "right": [0.45, 0.15, 0.3]}
    poses = arm.forward(joints)
    poses[:, :3, 3] = [centres[name] for name in names]
    joints, errors = Chain.of(arm).solve(poses, joints)
    assert errors.max() < 1e-9
    joints[:, 3] -= 0.02
    write(folder / "sockets.csv", in_degrees(arm, joints) | {"socket": names})
    return folder / "sockets.csv"
