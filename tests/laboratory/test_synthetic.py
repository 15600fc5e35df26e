"""Calibrations of synthetic arms: the whole summary, the files, the recording and corrections."""

import csv
import json
import re
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import InvalidFile, calibrate, calibrate_arm, load_arm, load_correction
from recalib.laboratory.propose import propose
from recalib.laboratory.reaching import Goals
from recalib.laboratory.report import folder as report
from recalib.laboratory.report.page import draw_arm, draw_errors, draw_over_joints
from recalib.laboratory.report.recording import recording_of
from recalib.laboratory.report.summary import errors_table
from tests.arms import urdf
from tests.identification.real import Real
from tests.laboratory.conftest import in_degrees, in_millimetres, write
from tests.logged import logged

SLIDING = urdf(
    ("swing", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0.1"),
    ("reach", "prismatic", "1 0 0", "0.3 0 0"),
    ("turn", "revolute", "1 0 0", "0.2 0.03 0.01"),
    ("flange", "fixed", "0 0 1", "0.15 0 0.02"),
    mass=3.0,
).replace(
    "</inertial>", '</inertial><visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual>'
)
ROWS = 26


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """An arm with a joint that slides, and tables of poses and of two targets."""
    folder = tmp_path_factory.mktemp("synthetic")
    (folder / "sliding.urdf").write_text(SLIDING)
    arm = load_arm(folder / "sliding.urdf")
    real, rng = Real(arm, 4, targets=2, gears=0.002), np.random.default_rng(5)
    joints = rng.uniform(-0.9, 0.9, (ROWS, 4)) * [1.0, 0.8, 0.2, 1.1] + [0.1, -0.3, 0.4, 0.2]
    joints[:, 3] = np.where(np.arange(ROWS) % 7 == 2, joints[::-1, 3], joints[:, 3])
    clock = np.cumsum(rng.uniform(0.3, 2.0, ROWS))
    columns = in_degrees(arm, joints)
    del columns["reach [deg]"]
    columns["reach [cm]"] = 100 * joints[:, 2]
    poses = real.poses(joints)
    poses[6, :3, 3] += 0.02
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    nominal = 1e3 * (real.base @ arm.forward(joints))[:, :3, 3]
    nominal += rng.normal(scale=0.2, size=(ROWS, 3))
    rows = columns | in_millimetres(poses[:, :3, 3])
    rows |= {f"q{axis}": turns[:, index] for index, axis in enumerate("xyzw")}
    rows |= {f"{axis}_nominal [mm]": nominal[:, index] for index, axis in enumerate("xyz")}
    write(folder / "poses.csv", rows | {"time [min]": clock / 60, "note": ["x"] * ROWS})
    stand = np.linalg.inv(real.base)
    angles = np.degrees(Rotation.from_matrix(stand[:3, :3]).as_euler("xyz"))
    place = ", ".join(f'"{1e3 * number:.6f} mm"' for number in stand[:3, 3])
    turned = ", ".join(f'"{number:.6f} deg"' for number in angles)
    (folder / "poses.toml").write_text(
        f'[columns]\nnote = "ignored"\n[instrument]\nposition = [{place}]\n'
        f"roll_pitch_yaw = [{turned}]\n"
    )
    numbers = np.arange(ROWS) % 2
    balls = real.poses(joints, numbers)[:, :3, 3]
    names = np.array(["small", "large"])[numbers]
    write(folder / "targets.csv", columns | in_millimetres(balls) | {"target": names})
    return folder


@pytest.fixture(scope="module")
def calibration_of(lab):
    """A calibration by name, computed at its first use."""
    arguments = {
        "poses": (lab / "sliding.urdf", lab / "poses.csv", lab / "poses.toml"),
        "targets": (lab / "sliding.urdf", lab / "targets.csv"),
    }
    return cache(lambda name: calibrate_arm(*arguments[name]))


def test_the_summary_says_what_was_gained_what_is_doubted_and_what_is_open(calibration_of):
    """An arm that is off by 3 mm, of which gears leave half a millimetre, with 0.02 m in row 7."""
    _, first, *others = calibration_of("poses").summary().splitlines()
    before, after = map(float, re.search(r"falls from ([\d.]+) mm to ([\d.]+) mm", first).groups())
    assert 2 < before < 4 and 0.3 < after < 0.8
    assert first.endswith("1 of 26 rows left out as outliers.")
    assert "outliers (rows with almost no weight): 7" in others
    # what slides along a line and turns about it at the end of the arm moves the target as well
    for pair in ("offset of reach or shift x of target", "offset of turn or turn x of target"):
        assert f"not identifiable from any posture: {pair}" in others


@pytest.mark.parametrize("name", ["poses", "targets"])
def test_files_hold_what_the_result_says(name, calibration_of):
    result = calibration_of(name)
    files = report.files_of(result)
    assert [*files] == [
        *("summary.txt", "arm.urdf", "correction.npz", "parameters.json", "frames.csv", "rows.csv")
    ]
    values = json.loads(files["parameters.json"])
    assert [row["mean"] for row in values["errors"]] == [row.mean for row in errors_table(result)]
    offsets = {joint: row["value"] for joint, row in values["joint_offsets"].items()}
    identified = result.geometry.model.coefficients(result.geometry.estimate.parameters)["offset"]
    scales = np.where(result.arm.slides, 1e3, 180 / np.pi)
    assert [*offsets] == [*result.arm.joints]
    assert [*offsets.values()] == pytest.approx(scales * identified)
    rows = list(csv.DictReader(files["rows.csv"].decode().splitlines()))
    chosen = result.validation.held_out["in blocks"][result.validation.chosen].errors[:, 0]
    assert [float(row["after [mm]"]) for row in rows] == pytest.approx(1e3 * chosen, rel=1e-4)
    outliers = [int(row["row"]) for row in rows if row["outlier"] == "yes"]
    assert outliers == result.doubted.tolist() and (name != "poses" or 7 in outliers)


@pytest.mark.parametrize("name", ["arm.urdf", "correction.npz"])
def test_a_file_that_is_read_back_as_another_arm_is_not_written(name, calibration_of, monkeypatch):
    result = calibration_of("targets")
    other = calibration_of("poses")
    if name == "arm.urdf":
        monkeypatch.setitem(vars(result), "corrected", other.corrected)
    else:
        content = other.correction.archive()
        monkeypatch.setattr(type(result.correction), "archive", lambda _: content)
    with pytest.raises(InvalidFile, match=f"{name}: read back, its forward kinematics are .* off"):
        report.files_of(result)


def test_the_recording_shows_measured_rows_and_their_errors(calibration_of, tmp_path):
    result = calibration_of("poses")
    content, missing = recording_of(result)
    (tmp_path / "recording.rrd").write_bytes(content)
    values = logged(tmp_path / "recording.rrd")
    assert missing == ""
    (points,) = values["/measured Points3D:positions"]
    assert points.reshape(-1, 3) == pytest.approx(result.positions, abs=1e-6)
    for name, residuals in result.residuals.items():
        errors = 1e3 * np.linalg.norm(residuals[:, :3], axis=1)
        assert np.concatenate(values[f"/errors/{name} Scalars:scalars"]) == pytest.approx(errors)
        (arrows,) = values[f"/residuals/{name} Arrows3D:vectors"]
        longer = np.linalg.norm(arrows.reshape(-1, 3), axis=1) / errors
        assert longer == pytest.approx(longer[0], rel=1e-5)
    rows = np.unique(np.concatenate(values["/now row"]))
    assert rows.tolist() == (result.counted + 1).tolist()


def test_drawings_name_their_axes_and_are_the_same_again(calibration_of):
    result = calibration_of("poses")
    arm, longer = draw_arm(result)
    for text, labels in (
        (draw_errors(result), {"part of the rows", "cross-validated error [mm]"}),
        (draw_over_joints(result), {"position error [mm]", "lift [deg]", "reach [mm]"}),
        (arm, {"from the side", "from above", "x [m]", "y [m]", "z [m]"}),
    ):
        assert labels <= {*re.findall(r">([^<>]+)</text>", text)} and text.startswith("<svg")
        assert "<metadata" not in text
    assert draw_arm(result) == (arm, longer)
    largest = np.linalg.norm(result.residuals["before"][:, :3], axis=1).max()
    assert longer * largest == pytest.approx(0.12, rel=0.5)  # m, of an arm of about one


@pytest.mark.parametrize("name", ["poses", "targets"])
def test_corrections_reach_and_proposals_teach(name, calibration_of, tmp_path):
    result = calibration_of(name)
    result.correction.save(tmp_path / "correction.npz")
    correction = load_correction(tmp_path / "correction.npz")
    learned = correction.learned[:6] + 0.02
    numbers = np.arange(6) % len(correction.targets)
    desired = correction.calibration.predict(learned, numbers)[:, :3, 3]
    names = [correction.targets[number] for number in numbers]
    commands = correction.correct(desired, target=names)
    reached = correction.calibration.predict(commands.joints, numbers)[:, :3, 3]
    assert np.abs(reached - desired).max() < 1e-7
    ends = {"poses": "the tool link", "targets": "the arm's base and the tool link"}
    assert correction.unidentifiable_ends == ends[name]
    joints, deviations = propose(correction, 5)
    assert (np.diff(deviations) < 0).all() and len(joints) == 5
    candidates = np.concatenate([learned[:5], [[1.9] * 4]])  # the last near the ends of its ranges
    chosen = propose(correction, 3, candidates)[0]
    assert all((candidates[:5] == one).all(axis=1).any() for one in chosen)
    positions = correction.calibration.forward(learned)[:, :3, 3]
    by_position = propose(correction, 2, Goals.of(positions, None, 4))[0]
    gaps = correction.calibration.forward(by_position)[:, None, :3, 3] - positions
    assert np.linalg.norm(gaps, axis=2).min(axis=1).max() < 1e-7


def test_arrays_give_the_same_as_their_table(calibration_of, lab):
    """The same numbers through `calibrate` and through a table and a description."""
    result = calibration_of("targets")
    observations = result.data.observations
    names = np.array(result.data.targets)[observations.targets]
    arrays = calibrate(result.arm, observations.joints, observations.measured, targets=names)
    parameters = result.geometry.estimate.parameters
    assert np.array_equal(arrays.geometry.estimate.parameters, parameters)
    assert arrays.summary().splitlines()[1:3] == result.summary().splitlines()[1:3]
    pose = arrays.predict(observations.joints[0], "large")
    commands = arrays.correct(pose[:3, 3], observations.joints[0], "large")
    assert np.allclose(commands.joints, observations.joints[0], atol=1e-5)
