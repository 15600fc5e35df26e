"""What a table says; refusals stand in tests/mistakes_on_the_command_line.yaml."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import Description, InvalidFile, InvalidSetting, read_description
from recalib.files.quantities import LENGTH
from recalib.laboratory.tables.description import within
from recalib.laboratory.tables.measurements import (
    joint_headings,
    read_desired,
    read_joints,
    read_measurements,
)
from tests.arms import urdf
from tests.laboratory.conftest import write as write_columns

ROWS = 10
GANTRY = urdf(("rail", "prismatic", "1 0 0", "0 0 0"), ("wrist", "revolute", "0 0 1", "0 0 0"))


@pytest.fixture(scope="module")
def gantry(load):
    return load(GANTRY)


@pytest.fixture
def write(tmp_path):
    def write(columns: dict):
        write_columns(path := tmp_path / "table.csv", columns)
        return path

    return write


def joints() -> dict:
    return {"rail [mm]": np.linspace(0, 1500, ROWS), "wrist [deg]": np.linspace(-90, 90, ROWS)}


def positions() -> dict:
    return {f"{axis} [mm]": np.linspace(1, 2, ROWS) for axis in "xyz"}


def test_units_become_metres_and_radians_and_columns_stand_in_any_order(gantry, write):
    read = read_measurements(write(positions() | {**joints()}), gantry)
    assert np.allclose(read.joints[-1], [1.5, np.pi / 2])
    assert np.allclose(read.positions[-1], 0.002)
    assert read.columns.keys() == {"positions"}
    times = [0, 0, 1, 1, *range(2, ROWS - 2)]
    table = write(joints() | positions() | {"time [s]": times})
    assert read_measurements(table, gantry).columns["times"] == pytest.approx(times)


def test_a_table_that_was_pasted_twice_is_refused_and_a_row_that_repeats_is_not(gantry, write):
    columns = joints() | positions()
    twice = {name: [*cells, *cells] for name, cells in columns.items()}
    message = "10 of its 20 rows are copies of others, such as row 11 of row 1; expected: indep"
    with pytest.raises(InvalidFile, match=message):
        read_measurements(write(twice), gantry)
    once = {name: [*cells, cells[-1]] for name, cells in columns.items()}
    assert len(read_measurements(write(once), gantry)) == ROWS + 1


def test_the_three_ways_to_write_a_rotation_agree(gantry, write):
    turn = Rotation.from_rotvec([0.3, -0.2, 0.9])
    for names, numbers in (
        (("qx", "qy", "qz", "qw"), turn.as_quat()),
        (("rx [rad]", "ry [rad]", "rz [rad]"), turn.as_rotvec()),
        (("roll [deg]", "pitch [deg]", "yaw [deg]"), turn.as_euler("xyz", degrees=True)),
    ):
        cells = ([number] * ROWS for number in numbers)
        columns = joints() | positions() | dict(zip(names, cells, strict=True))
        read = read_measurements(write(columns), gantry)
        assert np.allclose(read.measured[:, :3, :3], turn.as_matrix())


@pytest.mark.parametrize(
    ("of_urdf", "heading"),
    [("e\u0301lan", "\u00e9lan"), ("\u00e9lan", "e\u0301lan"), (" a ", "a"), ("a", "a ")],
)
def test_names_that_look_alike_are_alike(of_urdf, heading, load, write):
    """With an accent of its own or not, and with blanks at the ends."""
    arm = load(GANTRY.replace('"rail"', f'"{of_urdf}"'))
    for first in (f"{heading} [mm]", joint_headings(arm)[0]):
        length, turn = joints().values()
        read = read_joints(write({first: length, "wrist [deg]": turn}), arm)
        assert np.allclose(read.joints[-1], [1.5, np.pi / 2])


def test_a_column_of_a_joint_that_follows_another_is_named(load, write):
    arm = load(GANTRY.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1"/><mimic joint="rail"/>'))
    with pytest.raises(InvalidFile, match="'wrist' is that of a joint that follows another by"):
        read_joints(write(joints()), arm)


@pytest.mark.parametrize("between", ["+-", " +- ", "+/-", " +/- ", "±", " ± "])
def test_a_deviation_is_written_in_three_ways(between):
    assert within("here", f"3 mm{between}1 mm", LENGTH) == (0.003, 0.001)
    with pytest.raises(InvalidSetting, match="deviation of here is '0 mm'; expected: more than"):
        within("here", f"3 mm{between}0 mm", LENGTH)


def test_targets_and_sockets_are_named_also_in_what_is_desired(gantry, write):
    names = ["left", "right"] * (ROWS // 2)
    read = read_measurements(write(joints() | {"socket": names, "target": names}), gantry)
    assert [*read.columns["sockets"]] == [*read.columns["targets"]] == names
    assert read.positions is None
    names = {"target": ["board"] * ROWS, "picture": ["a.png"] * ROWS}
    read = read_desired(write(joints() | positions() | names), gantry, target=True)
    assert [*read.columns["targets"]] == names["target"] and np.allclose(read.positions[-1], 0.002)


def test_what_was_measured_at_commands_may_stand_beside_their_fake_poses(gantry, write):
    path = write(joints() | positions() | {f"{axis}_fake [mm]": [1.0] * ROWS for axis in "xyz"})
    assert np.allclose(read_measurements(path, gantry).positions[-1], 0.002)
    with pytest.raises(InvalidFile, match="its commands are corrected already"):
        read_desired(path, gantry)


def test_what_is_no_text_is_refused(gantry, tmp_path):
    path = tmp_path / "table.csv"
    path.write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(InvalidFile, match="it is not CSV in UTF-8"):
        read_measurements(path, gantry)


DESCRIPTION = """
[columns]
j1 = "rail [mm]"
j2 = "wrist [deg]"
x_t = "x_nominal [mm]"
y_t = "y_nominal [mm]"
z_t = "z_nominal [mm]"
x_dif = "x_error [mm]"
y_dif = "y_error [mm]"
z_dif = "z_error [mm]"
step = "ignored"
[instrument]
position = ["1 m", "-2 cm", "0.07 mm"]
[target]
roll_pitch_yaw = ["10 deg", "-0.2 rad", "30 deg"]
[[distance]]
sockets = ["right", "left"]
length = "250 mm"
"""


def test_a_description_says_what_a_table_does_not(gantry, write, tmp_path):
    path = tmp_path / "description.toml"
    path.write_text(DESCRIPTION)
    description = read_description(path)
    shifts = [[0, 0, 0, shift] for shift in (1, -0.02, 7e-5)]
    assert np.allclose(description.instrument[:3], np.eye(3, 4) + shifts)
    angles = Rotation.from_matrix(description.target[:3, :3]).as_euler("xyz")
    assert np.allclose(angles, [np.radians(10), -0.2, np.radians(30)])
    assert np.array_equal(description.target[:3, 3], np.zeros(3))
    assert description.distances == {("left", "right"): 0.25}
    columns = dict(zip(("j1", "j2"), joints().values(), strict=True)) | {"step": range(ROWS)}
    columns |= {f"{axis}_t": range(ROWS) for axis in "xyz"}
    columns |= {f"{axis}_dif": [1] * ROWS for axis in "xyz"}
    read = read_measurements(write(columns), gantry, description)
    assert np.allclose(read.joints[-1], [1.5, np.pi / 2])
    assert np.allclose(read.columns["nominal"], 1e-3 * np.arange(ROWS)[:, None])
    assert np.allclose(read.positions - read.columns["nominal"], 0.001)
    columns["j1"] = ["far"] * ROWS
    with pytest.raises(InvalidFile, match="row 1 of column 'j1' is 'far'"):
        read_measurements(write(columns), gantry, description)
    every = Description(dict.fromkeys(columns, "ignored"))
    with pytest.raises(InvalidFile, match="its description ignores every column"):
        read_measurements(write(columns), gantry, every)


@pytest.mark.parametrize(
    ("column", "cells", "start"),
    [
        ("time [s]", [f"{1.5 * row}" for row in range(ROWS)], 0),
        ("time [ms]", [1500 * row for row in range(ROWS)], 0),
        ("time", [f"2026-11-23T08:00:{1.5 * row:06.3f}" for row in range(ROWS)], 1795420800),
        ("time", [f"2026-11-23 08:00:{1.5 * row:06.3f}+01:00" for row in range(ROWS)], 1795417200),
    ],
)
def test_times_are_seconds_or_dates(column, cells, start, gantry, write):
    read = read_measurements(write(joints() | positions() | {column: cells}), gantry)
    times = read.columns["times"]
    assert np.allclose(times, start + 1.5 * np.arange(ROWS), rtol=0, atol=1e-6)
