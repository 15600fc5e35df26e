"""An arm of which two sections follow one motor, from its table to commands."""

import numpy as np
import pandas as pd

from recalib import calibrate, load_arm
from recalib.laboratory.command_line import DONE, main
from tests.arms import urdf
from tests.laboratory.conftest import write

ROWS = 40
SECTION = '<mimic joint="lift" multiplier="0.5" offset="-0.1"/>'
LIFT = urdf(
    ("lift", "prismatic", "0 0 1", "0 0 0.5"),
    ("top", "prismatic", "0 0 1", "0 0 0.2", SECTION),
    ("turn", "revolute", "0 0 1", "0 0 0.1"),
    ("yaw", "revolute", "0 1 0", "0.3 0 0"),
    ("end", "fixed", "0 0 1", "0.25 0 0"),
)
BENT = 'xyz="0.3 0 0" rpy="0 0 0"', 'xyz="0.306 0.004 0" rpy="0.01 0 0.02"'


def test_one_column_moves_both_sections(tmp_path):
    """A joint called as a measured angle is measured, too; positions are to 0.05 mm."""
    (tmp_path / "lift.urdf").write_text(LIFT)
    (tmp_path / "bent.urdf").write_text(LIFT.replace(*BENT))
    arm, bent = load_arm(tmp_path / "lift.urdf"), load_arm(tmp_path / "bent.urdf")
    rng = np.random.default_rng(3)
    columns = rng.uniform([0.1, -1.5, -1.2], [1.2, 1.5, 1.2], (ROWS, 3))
    errors = np.array([0.004, 0.002, 0.01, -0.015])  # m, rad

    def true(columns):
        return bent.forward(arm.coupling.joints(columns) + errors)[:, :3, 3]

    measured = true(columns) + rng.normal(scale=5e-5, size=(ROWS, 3))
    names = "lift [mm]", "turn [deg]", "yaw [deg]"
    cells = dict(zip(names, (columns * [1e3, 180 / np.pi, 180 / np.pi]).T, strict=True))
    cells |= {f"{axis} [m]": measured[:, index] for index, axis in enumerate("xyz")}
    write(tmp_path / "rows.csv", cells)
    files = [str(tmp_path / name) for name in ("lift.urdf", "rows.csv")]
    assert main(["calibrate", *files, f"--out={tmp_path / 'out'}"]) == DONE
    fresh = rng.uniform([0.2, -1.3, -1.0], [1.1, 1.3, 1.0], (10, 3))
    desired = {f"{axis} [m]": true(fresh)[:, index] for index, axis in enumerate("xyz")}
    write(tmp_path / "desired.csv", desired)
    out = tmp_path / "commands.csv"
    given = [str(tmp_path / "out"), f"{tmp_path}/desired.csv"]
    assert main(["correct", *given, f"--out={out}"]) == DONE
    cells = pd.read_csv(out)
    commands = np.array([cells[name] for name in ("lift [mm]", "turn [deg]", "joint yaw [deg]")]).T
    reached = true(commands / [1e3, 180 / np.pi, 180 / np.pi])
    assert np.linalg.norm(reached - true(fresh), axis=1).max() < 2e-4
    arguments = ["next", str(tmp_path / "out"), "--count=3", f"--out={tmp_path / 'next.csv'}"]
    assert main(arguments) == DONE
    assert [*pd.read_csv(tmp_path / "next.csv")][:3] == [
        "lift [mm]",
        "turn [deg]",
        "joint yaw [deg]",
    ]
    result = calibrate(arm, columns, measured)
    assert np.abs(result.predict(fresh)[:, :3, 3] - true(fresh)).max() < 2e-4
