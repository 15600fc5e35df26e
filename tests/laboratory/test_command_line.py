"""The commands from a table to the commands of a controller, on an arm that the tests bend."""

import hashlib
import json
import os
import re
import sys
from dataclasses import replace
from pathlib import Path
from warnings import catch_warnings, simplefilter

import numpy as np
import pandas as pd
import pytest

from recalib import OFFSETS as TERMS
from recalib import load_arm, load_correction
from recalib.identification.model import ErrorModel
from recalib.laboratory.command_line import CACHE, DONE, NO_BETTER, REFUSED, main
from recalib.laboratory.report.page import figure_of, svg_of
from tests.conftest import run
from tests.laboratory.conftest import (
    ARM,
    NOISE,
    ROWS,
    angles_in,
    in_degrees,
    in_millimetres,
    measured,
    postures,
    table,
    to_instrument,
    true_positions,
    write,
)


def test_a_calibration_is_a_folder_of_files_that_tell_one_story(calibrated):
    files = {path.name for path in calibrated.iterdir()}
    expected = {"summary.txt", "arm.urdf", "correction.npz", "parameters.json", "frames.csv"}
    assert files == expected | {"rows.csv", "page.html", "recording.rrd"}
    values = json.loads((calibrated / "parameters.json").read_text())
    best = [row for row in values["errors"] if row["chosen"] and row["folds"] == "at random"]
    assert best[0]["mean"] < 4e3 * NOISE
    first, verdict, *others = (calibrated / "summary.txt").read_text().splitlines()
    digest = hashlib.sha256(ARM.encode()).hexdigest()[:12]
    assert first == f"{calibrated.parent / 'arm.urdf'} (sha256 {digest}), link_4 in base"
    errors = {row["folds"]: row["mean"] for row in values["errors"] if row["chosen"]}
    assert verdict.startswith("On postures away from those measured, the mean error falls from ")
    assert f" to {errors['in blocks']:.3g} mm, 95 % within " in verdict
    assert verdict.endswith(f"; near them, to {errors['at random']:.3g} mm.")
    assert next(line for line in others if line.startswith("in blocks"))
    # data decide four for each joint and six at the ends, without how the target is turned
    decided = [row["name"] for row in values["parameters"] if row["decided_by"] == "data"]
    assert 9 < len(decided) <= 4 * 3 + 3
    page = (calibrated / "page.html").read_text()
    text = page.replace("\n", " ")
    assert f"{len(decided)} of the {len(values['parameters'])} parameters" in text
    assert page.count("<svg") == 3
    assert "<script" not in page and "<link" not in page and 'src="http' not in page


def test_commands_take_the_calibrated_arm_to_what_is_desired(calibrated, arm, folder, capsys):
    joints = postures(10, 10, part=0.8)
    goals = load_correction(calibrated / "correction.npz").calibration.predict(joints)[:, :3, 3]
    write(folder / "desired.csv", in_millimetres(goals))
    out = folder / "commands.csv"
    assert main(["correct", str(calibrated), str(folder / "desired.csv"), f"--out={out}"]) == DONE
    columns = pd.read_csv(out)
    commanded = angles_in(columns, arm)
    assert np.allclose(commanded, joints, atol=1e-6)
    fake = 1e-3 * np.array([columns[f"{axis}_fake [mm]"] for axis in "xyz"]).T
    assert np.allclose(fake, arm.forward(commanded)[:, :3, 3], atol=1e-9)
    printed = capsys.readouterr()
    assert "leave the measured range" not in printed.err
    assert printed.out == (
        f"10 commands in {out}: joint coordinates, and at them\n"
        "the poses of link_4 in base by the nominal kinematics\n"
    )

    again = folder / "twice.csv"
    assert main(["correct", str(calibrated), str(out), f"--out={again}"]) == REFUSED
    assert "its commands are corrected already; expected: des" in capsys.readouterr().err


def test_without_a_known_instrument_commands_are_right_in_its_frame_and_refused_in_the_base(
    calibrated, arm, folder, capsys
):
    joints = postures(10, 10, part=0.8)
    goals = to_instrument(true_positions(arm, joints))
    write(folder / "seen.csv", in_millimetres(goals))
    desired, out = str(folder / "seen.csv"), folder / "seen_commands.csv"
    arguments = ["correct", str(calibrated / "correction.npz"), desired, f"--out={out}"]
    assert main(arguments) == DONE
    columns = pd.read_csv(out)
    commanded = angles_in(columns, arm)
    reached = to_instrument(true_positions(arm, commanded))
    assert np.abs(reached - goals).max() < 6 * NOISE
    assert "not identifiable" not in capsys.readouterr().err
    turned = dict.fromkeys(["rx [deg]", "ry [deg]", "rz [deg]"], np.zeros(10))
    write(folder / "turned.csv", in_millimetres(goals) | turned)
    arguments[2:] = [str(folder / "turned.csv"), f"--out={folder / 'no.csv'}"]
    assert main(arguments) == REFUSED
    assert "measured positions do not determine a target's rotation" in capsys.readouterr().err
    assert main([*arguments, "--frame=base"]) == REFUSED
    assert "arm's base is not identifiable from the measurements;" in capsys.readouterr().err
    write(folder / "joints.csv", in_degrees(arm, postures(3)))
    arguments[2] = str(folder / "joints.csv")
    assert main(arguments) == REFUSED
    text = capsys.readouterr().err
    assert "joints.csv: joints alone mean poses in the arm's base, which the" in text
    assert not (folder / "no.csv").exists()


@pytest.fixture(scope="module")
def in_base(arm, folder):
    """A calibration whose instrument and target are known: poses may be desired in the base."""
    joints = postures(12)
    write(folder / "known.csv", table(arm, joints, measured(arm, joints, 13)))
    lines = '[instrument]\nposition = ["0 m", "0 m", "0 m"]\n'
    (folder / "known.toml").write_text(lines + lines.replace("instrument", "target"))
    files = [str(folder / name) for name in ("arm.urdf", "known.csv")]
    options = f"--description={folder / 'known.toml'}", f"--out={folder / 'known'}"
    assert main(["calibrate", *files, *options]) == DONE
    return folder / "known"


@pytest.mark.parametrize("given", ["base", "instrument"])
def test_a_table_whose_joints_reach_its_poses_in_the_other_frame_is_refused(
    given, in_base, arm, tmp_path, capsys
):
    """As measurements, which are in the instrument's frame, that are desired in the base."""
    correction = load_correction(in_base)
    elsewhere = np.diag([-1.0, -1.0, 1.0, 1.0])
    frames = replace(correction.calibration.model.frames, base=elsewhere)
    model = ErrorModel(correction.arm, TERMS, frames)
    calibration = replace(correction.calibration, model=model)
    replace(correction, calibration=calibration).save(tmp_path / "correction.npz")
    joints = postures(10, 10, part=0.8)
    places = {"base": calibration.forward(joints), "instrument": calibration.predict(joints)}
    for frame, poses in places.items():
        write(tmp_path / "desired.csv", table(arm, joints, poses[:, :3, 3]))
        arguments = ["correct", str(tmp_path), f"{tmp_path}/desired.csv", f"--frame={given}"]
        code = main([*arguments, f"--out={tmp_path}/{frame}.csv"])
        assert code == (DONE if frame == given else REFUSED)
    (other,) = places.keys() - {given}
    message = f"recalib: frame is '{given}'; expected: {other}, because the joints reach"
    assert message in capsys.readouterr().err


def test_beyond_what_was_learned_it_warns(in_base, folder, capsys):
    columns = {"swing [deg]": [0, -95, 100], "lift [deg]": [-40] * 3, "elbow [deg]": [63] * 3}
    last = {name: angles[2:] for name, angles in columns.items()}
    write(folder / "far.csv", last)
    out = folder / "far_commands.csv"
    assert main(["correct", str(in_base), str(folder / "far.csv"), f"--out={out}"]) == DONE
    printed = capsys.readouterr()
    assert "1 of 1 command leaves the measured range of swing; the farthest is row 1" in printed.err
    assert printed.out.startswith("1 command in ") and "turns by" not in printed.err
    write(folder / "wide.csv", columns)
    out = folder / "wide_commands.csv"
    assert main(["correct", str(in_base), str(folder / "wide.csv"), f"--out={out}"]) == DONE
    text = capsys.readouterr().err
    assert "2 of 3 commands leave the measured range of swing; the farthest is row 3" in text
    assert "warning: swing turns by 195 deg from row 2 to row 3; try: " in text
    beyond, low, high = re.search(r", with swing (.*) deg beyond (.*) to (.*) deg\n", text).groups()
    assert -52 < float(low) < -40 < 40 < float(high)
    assert float(beyond) == pytest.approx(100 - float(high), abs=3)


def test_the_next_postures_are_within_limits_and_teach(calibrated, arm, folder, capsys):
    out = folder / "next.csv"
    assert main(["next", str(calibrated), "--count=4", f"--out={out}"]) == DONE
    proposed = angles_in(pd.read_csv(out), arm)
    assert proposed.shape == (4, 3) and np.abs(proposed).max() < 0.95 * 2
    message = (
        r"4 postures in .*, the most informative first\.\nThey would reduce the uncertainty of"
    )
    message += r" predicted positions from 0\.0\d+ mm to 0\.0\d+ mm[.:]"
    assert re.match(message, capsys.readouterr().out)
    measured = np.random.default_rng(0).uniform(-1.99, 1.99, (30, 3))  # up to the limits
    replace(load_correction(calibrated), learned=measured).save(folder / "wide.npz")
    assert main(["next", str(folder / "wide.npz"), "--count=9", f"--out={folder}/ends.csv"]) == DONE
    assert np.abs(angles_in(pd.read_csv(folder / "ends.csv"), arm)).max() <= 0.95 * 2 + 1e-9


@pytest.mark.parametrize("beyond", [1, 5])
def test_candidates_that_are_left_out_are_counted(beyond, calibrated, folder, capsys):
    ends = [114.0, -114.0, 114.0, 114.0, -114.0]  # deg
    swing = [1e-3 * row for row in range(4)] + ends[:beyond]
    cells = {f"{joint} [deg]": [0.0] * len(swing) for joint in ("lift", "elbow")}
    write(folder / "candidates.csv", {"swing [deg]": swing} | cells)
    out = f"--out={folder / 'chosen.csv'}"
    assert main(["next", str(calibrated), str(folder / "candidates.csv"), out]) == DONE
    assert f"warning: {beyond} of {4 + beyond} candidates left out: out" in capsys.readouterr().err
    Path(folder, "chosen.csv").unlink()


def test_letters_that_a_drawing_lacks_are_no_reason_for_a_warning():
    with catch_warnings():
        simplefilter("error")
        figure, panels = figure_of(2.0, 1, 1)
        panels[0, 0].set_xlabel("关节")
        assert "关节" in svg_of(figure)


def test_an_arm_without_errors_is_left_alone(arm, folder):
    noise = NOISE * np.random.default_rng(11).standard_normal((ROWS, 3))
    joints = postures(8)
    write(folder / "good.csv", table(arm, joints, arm.forward(joints)[:, :3, 3] + noise))
    out = folder / "nothing"
    arguments = [str(folder / "arm.urdf"), str(folder / "good.csv"), f"--out={out}"]
    assert main(["calibrate", *arguments]) == NO_BETTER
    assert "does not reduce the error" in (out / "summary.txt").read_text()
    assert not (out / "arm.urdf").exists() and not (out / "correction.npz").exists()


def test_a_command_leaves_linear_algebra_to_one_thread_before_numpy_counts_cores(monkeypatch):
    for threads in ("4", "1"):
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", threads)
        assert main(["next", "nowhere"]) == REFUSED
        assert os.environ["OPENBLAS_NUM_THREADS"] == threads
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    assert main(["next", "nowhere"]) == REFUSED
    assert os.environ["OPENBLAS_NUM_THREADS"] == "1"


@pytest.mark.parametrize("angle", [-1.2, 0.0, 0.35])
def test_a_parked_joint_is_held_at_any_angle_and_named(angle, tmp_path, capsys):
    arm, random = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng(3)
    joints = np.array([0, -1.4, 2.1, -2.9, -1.6, 0]) + random.uniform(-0.5, 0.5, (40, 6))
    joints[:, 0] = angle
    offsets = np.radians(random.uniform(-1, 1, 6))
    noise = NOISE * random.standard_normal((40, 3))
    positions = arm.forward(joints + offsets)[:, :3, 3] + noise
    write(tmp_path / "rows.csv", table(arm, joints, positions))
    arguments = ["ur10_robot.urdf", f"{tmp_path}/rows.csv", "--tool=tool0", f"--out={tmp_path}/out"]
    assert main(["calibrate", *arguments]) == DONE
    at = f"{np.degrees(angle):.1f} deg"
    expected = f"shoulder_pan_joint stood still at {at}: its own errors are not identifiable"
    assert expected in capsys.readouterr().out.splitlines()
    values = json.loads((tmp_path / "out" / "parameters.json").read_text())
    values = [row["value"] for row in values["parameters"] if row["name"].startswith("offset of ")]
    assert abs(values[0]) < 1e-9 < 1e-2 < np.abs(values[1:]).max()


@pytest.mark.slow  # in a process of its own
def test_a_calibration_writes_nothing_at_home_and_leaves_nothing_temporary(calibrated, tmp_path):
    home, temporary, out = (tmp_path / name for name in ("home", "temporary", "out"))
    home.mkdir()
    temporary.mkdir()
    own = {"HOME": str(home), "TMPDIR": str(temporary)}
    elsewhere = {CACHE, "XDG_CACHE_HOME", "XDG_CONFIG_HOME"}
    inherited = {name: value for name, value in os.environ.items() if name not in elsewhere}
    files = [str(calibrated.parent / name) for name in ("arm.urdf", "measurements.csv")]
    command = sys.executable, "-m", "recalib", "calibrate", *files, f"--out={out}"
    run(*command, env=inherited | own, check=True)
    assert (out / "page.html").exists()
    assert not [*home.rglob("*"), *temporary.rglob("*")]
