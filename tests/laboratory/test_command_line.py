"""The commands from a table to the commands of a controller, on an arm that the tests bend."""

import csv
import hashlib
import json
import os

import numpy as np
import pytest

from recalib.laboratory.command_line import DONE, NO_BETTER, REFUSED, main
from recalib.laboratory.correction import load_correction
from recalib.nominal.arms import load_arm
from tests.arms import urdf
from tests.conftest import loaded_with

NOISE = 5e-5  # m
ROWS = 30
OFFSETS = np.array([0.02, -0.015, 0.01])  # rad
ARM = urdf(
    ("swing", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0.1"),
    ("elbow", "revolute", "0 1 0", "0.4 0 0"),
    ("flange", "fixed", "0 0 1", "0.35 0 0.02"),
)
SEEN = np.array([0.9, 0.5, 0.6])  # rad about the middle
MIDDLE = np.array([0.0, -0.7, 1.1])


def true_positions(arm, joints: np.ndarray) -> np.ndarray:
    """Where the bent arm goes [m]."""
    return arm.forward(joints + OFFSETS)[:, :3, 3]


def to_instrument(positions: np.ndarray) -> np.ndarray:
    """From the arm's base to where the camera stands."""
    return positions @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [1.0, 0.5, -0.2]


def write(path, columns: dict[str, np.ndarray]) -> None:
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def table(arm, joints: np.ndarray, positions: np.ndarray) -> dict[str, np.ndarray]:
    columns = {f"{joint} [deg]": np.degrees(joints[:, i]) for i, joint in enumerate(arm.joints)}
    return columns | {f"{axis} [mm]": 1e3 * positions[:, i] for i, axis in enumerate("xyz")}


def read(path) -> dict[str, np.ndarray]:
    with path.open(newline="") as stream:
        heading, *rows = csv.reader(stream)
    return dict(zip(heading, np.array(rows, dtype=float).T, strict=True))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("laboratory")


@pytest.fixture(scope="module")
def arm(folder):
    path = folder / "arm.urdf"
    path.write_text(ARM)
    return load_arm(path)


@pytest.fixture(scope="module")
def seen(arm, folder):
    """A camera somewhere sees a target somewhere on the tool."""
    random = np.random.default_rng(8)
    joints = MIDDLE + SEEN * random.uniform(-1, 1, (ROWS, 3))
    positions = true_positions(arm, joints) + NOISE * random.standard_normal((ROWS, 3))
    write(folder / "measurements.csv", table(arm, joints, to_instrument(positions)))
    return joints


@pytest.fixture(scope="module")
def calibrated(arm, seen, folder):
    out = folder / "calibration"
    code = main(
        ["calibrate", str(folder / "arm.urdf"), str(folder / "measurements.csv"), f"--out={out}"]
    )
    assert code == DONE
    return out


def test_a_calibration_is_a_folder_of_files(calibrated):
    files = {path.name for path in calibrated.iterdir()}
    expected = {"summary.txt", "arm.urdf", "correction.npz", "parameters.csv", "parameters.json"}
    expected |= {"joint_offsets.csv", "rows.csv", "page.html", "recording.rrd", "frames.csv"}
    assert expected == files
    told = json.loads((calibrated / "parameters.json").read_text())
    best = [row for row in told["errors"] if row["chosen"] and row["folds"] == "at random"]
    assert best[0]["mean"] < 4e3 * NOISE
    first, verdict, *others = (calibrated / "summary.txt").read_text().splitlines()
    digest = hashlib.sha256(ARM.encode()).hexdigest()[:12]
    assert first == f"{calibrated.parent / 'arm.urdf'} (sha256 {digest}), link_4 in base"
    errors = {row["folds"]: row["mean"] for row in told["errors"] if row["chosen"]}
    assert verdict.startswith("On postures away from those measured, the mean error falls from ")
    assert f" to {errors['in blocks']:.3g} mm, 95 % within " in verdict
    assert verdict.endswith(f"; near them, to {errors['at random']:.3g} mm.")
    assert next(line for line in others if line.startswith("in blocks"))


def test_data_decide_no_more_parameters_than_they_can_tell_apart(calibrated):
    """Four for each joint and six at the ends, without how the target is turned."""
    told = json.loads((calibrated / "parameters.json").read_text())
    decided = [each["name"] for each in told["parameters"] if each["decided_by"] == "data"]
    assert 9 < len(decided) <= 4 * 3 + 3
    assert f"{len(decided)} of the {len(told['parameters'])} parameters" in (
        calibrated / "page.html"
    ).read_text().replace("\n", " ")


def test_the_page_asks_for_nothing_from_elsewhere(calibrated):
    page = (calibrated / "page.html").read_text()
    assert page.count("<svg") == 3
    assert "<script" not in page and "<link" not in page and 'src="http' not in page


def test_the_corrected_urdf_takes_the_target_where_the_arm_does(calibrated, arm):
    """As far as it was measured: between positions, since nobody knows where the camera stands."""
    told = json.loads((calibrated / "parameters.json").read_text())
    (target,) = told["targets_in_tool"].values()
    joints = MIDDLE + SEEN * np.random.default_rng(9).uniform(-1, 1, (50, 3))
    true = between(true_positions(arm, joints))
    before = between(arm.forward(joints)[:, :3, 3])
    again = load_arm(calibrated / "arm.urdf").forward(joints) @ np.array(target)
    assert np.abs(before - true).max() > 5e-3
    assert np.abs(between(again[:, :3, 3]) - true).max() < 8 * NOISE


def between(positions: np.ndarray) -> np.ndarray:
    return np.linalg.norm(positions[:, None] - positions[None], axis=2)


def test_commands_take_the_identified_arm_to_what_is_desired(calibrated, arm, folder, capsys):
    joints = MIDDLE + 0.8 * SEEN * np.random.default_rng(10).uniform(-1, 1, (10, 3))
    goals = load_correction(calibrated / "correction.npz").calibration.forward(joints)[:, :3, 3]
    write(folder / "desired.csv", {f"{a} [mm]": 1e3 * goals[:, i] for i, a in enumerate("xyz")})
    out = folder / "commands.csv"
    assert main(["correct", str(calibrated), str(folder / "desired.csv"), f"--out={out}"]) == DONE
    sent = read(out)
    commanded = np.radians([sent[f"{joint} [deg]"] for joint in arm.joints]).T
    assert np.allclose(commanded, joints, atol=1e-6)
    fake = 1e-3 * np.array([sent[f"{axis} [mm]"] for axis in "xyz"]).T
    assert np.allclose(fake, arm.forward(commanded)[:, :3, 3], atol=1e-9)
    assert "leave the range" not in capsys.readouterr().err


def test_to_the_instrument_commands_are_right_where_the_base_is_not_known(
    calibrated, arm, folder, capsys
):
    joints = MIDDLE + 0.8 * SEEN * np.random.default_rng(10).uniform(-1, 1, (10, 3))
    goals = to_instrument(true_positions(arm, joints))
    write(folder / "seen.csv", {f"{a} [mm]": 1e3 * goals[:, i] for i, a in enumerate("xyz")})
    desired, out = str(folder / "seen.csv"), folder / "seen_commands.csv"
    arguments = ["correct", str(calibrated), desired, f"--out={out}"]
    assert main([*arguments, "--frame=instrument"]) == DONE
    sent = read(out)
    commanded = np.radians([sent[f"{joint} [deg]"] for joint in arm.joints]).T
    reached = to_instrument(true_positions(arm, commanded))
    assert np.abs(reached - goals).max() < 6 * NOISE
    assert "could not be told" not in capsys.readouterr().err
    write(folder / "base.csv", {"x [m]": [0.6], "y [m]": [0.0], "z [m]": [0.4]})
    other = folder / "base_commands.csv"
    main(["correct", str(calibrated), str(folder / "base.csv"), f"--out={other}"])
    told = capsys.readouterr().err
    assert "warning: the arm's base and the tool link could not be told from errors" in told


def test_what_is_out_of_reach_is_refused_by_its_row(calibrated, folder, capsys):
    write(folder / "far.csv", {"x [m]": [0.6, 3], "y [m]": [0, 0], "z [m]": [0.4, 0]})
    assert main(["correct", str(calibrated), str(folder / "far.csv")]) == REFUSED
    assert "recalib: row 2 cannot be reached: the nearest posture leaves" in capsys.readouterr().err


def test_beyond_what_was_learned_it_warns(calibrated, folder, capsys):
    columns = {"swing [deg]": [0, 100], "lift [deg]": [-40, -40], "elbow [deg]": [63, 63]}
    write(folder / "wide.csv", columns)
    out = folder / "wide_commands.csv"
    assert main(["correct", str(calibrated), str(folder / "wide.csv"), f"--out={out}"]) == DONE
    told = capsys.readouterr().err
    assert "1 of 2 commands, first in row 2, leave the range that was learned from: swing" in told


def test_the_next_postures_are_within_limits_and_teach(calibrated, arm, folder, capsys):
    out = folder / "next.csv"
    assert main(["next", str(calibrated), "--count=4", f"--out={out}"]) == DONE
    proposed = np.radians([read(out)[f"{joint} [deg]"] for joint in arm.joints])
    assert proposed.shape == (3, 4) and np.abs(proposed).max() < 0.95 * 2
    assert "uncertainty of predicted positions fall from" in capsys.readouterr().out


def test_of_candidates_those_near_the_end_of_a_joint_are_left_out(calibrated, folder):
    columns = {"swing [rad]": [0, 0.5, 1.95], "lift [rad]": [-0.7] * 3, "elbow [rad]": [1.1] * 3}
    write(folder / "candidates.csv", columns)
    out = folder / "chosen.csv"
    candidates = str(folder / "candidates.csv")
    assert main(["next", str(calibrated), candidates, f"--out={out}"]) == DONE
    assert sorted(read(out)["swing [deg]"]) == pytest.approx([0, np.degrees(0.5)])


def test_candidates_none_of_which_is_of_use_are_refused(calibrated, folder, capsys):
    write(folder / "away.csv", {"x [m]": [9, 8], "y [m]": [0, 0], "z [m]": [0, 0]})
    assert main(["next", str(calibrated), str(folder / "away.csv")]) == REFUSED
    told = capsys.readouterr().err
    assert told.startswith("recalib: candidates is '2 postures of no use'; valid: within reach")


def test_an_arm_without_errors_is_left_alone(arm, seen, folder, capsys):
    random = np.random.default_rng(11)
    positions = arm.forward(seen)[:, :3, 3] + NOISE * random.standard_normal((ROWS, 3))
    write(folder / "good.csv", table(arm, seen, positions))
    out = folder / "nothing"
    arguments = [str(folder / "arm.urdf"), str(folder / "good.csv"), f"--out={out}"]
    assert main(["calibrate", *arguments]) == NO_BETTER
    assert "no better than doing nothing" in (out / "summary.txt").read_text()
    assert not (out / "arm.urdf").exists() and not (out / "correction.npz").exists()


def test_a_mistake_is_told_in_one_sentence(arm, folder, capsys):
    (folder / "empty.csv").write_text("")
    code = main(["calibrate", str(folder / "arm.urdf"), str(folder / "empty.csv")])
    told = capsys.readouterr().err
    assert code == REFUSED and told == f"recalib: cannot use {folder / 'empty.csv'}: it is empty\n"
    assert main(["correct", str(folder), str(folder / "empty.csv")]) == REFUSED
    assert "correction.npz: No such file or directory" in capsys.readouterr().err


def test_a_command_leaves_linear_algebra_to_one_thread_before_numpy_counts_cores(monkeypatch):
    assert loaded_with("import recalib.laboratory.command_line", {"numpy"}) == set()
    for threads in ("4", "1"):
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", threads)
        assert main(["next", "nowhere"]) == REFUSED
        assert os.environ["OPENBLAS_NUM_THREADS"] == threads
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    assert main(["next", "nowhere"]) == REFUSED
    assert os.environ["OPENBLAS_NUM_THREADS"] == "1"
