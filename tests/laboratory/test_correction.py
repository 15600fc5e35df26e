import json
import tempfile
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from recalib import (
    JOINT_ERRORS,
    OFFSETS,
    Correction,
    InvalidFile,
    NotReached,
    Observations,
    RecalibError,
    load_arm,
    load_correction,
    position_error,
)
from recalib.files import write_archive
from recalib.identification import calibrate
from recalib.identification.model import Frames
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.nominal import find_urdf
from tests.arms import SCARA
from tests.laboratory.conftest import postures
from tests.spoiling import spoil

HOME = np.array([0, 0.2, 0, -2, 0, 2.2, 0.8])


@pytest.fixture(scope="module")
def correction():
    """Of a seven-jointed arm with an offset and an eccentric gear."""
    arm = load_arm("panda.urdf", "panda_hand_tcp")
    joints = HOME + np.random.default_rng(6).uniform(-0.6, 0.6, (60, 7))
    bent = joints + 0.01 + 0.004 * np.sin(joints)
    observations = Observations(joints, arm.forward(bent))
    calibration = calibrate(arm, (OFFSETS, JOINT_ERRORS), observations)
    return Correction(find_urdf("panda.urdf").read_bytes(), calibration, joints)


def test_a_urdf_may_be_in_another_encoding(correction, tmp_path):
    """As its first line says: the file is kept as it is."""
    urdf = correction.urdf.replace(b"<robot", "<!-- Gerät --><robot".encode("latin-1"), 1)
    urdf = b'<?xml version="1.0" encoding="ISO-8859-1"?>' + urdf[urdf.index(b"?>") + 2 :]
    replace(correction, urdf=urdf).save(tmp_path / "correction.npz")
    again = load_correction(tmp_path / "correction.npz")
    assert again.urdf == urdf and again.arm.joints == correction.arm.joints


def test_a_redundant_arm_stays_near_the_posture_that_is_given(correction):
    joints = HOME + np.random.default_rng(7).uniform(-0.4, 0.4, (10, 7))
    goals = correction.calibration.forward(joints)
    nearby = joints + np.random.default_rng(8).uniform(-0.05, 0.05, joints.shape)
    commands = correction.correct(goals, nearby, frame="base")
    reached = correction.calibration.forward(commands.joints)
    assert np.abs(reached - goals).max() < 1e-7
    assert np.abs(commands.joints - nearby).max() < 0.1
    assert np.array_equal(commands.poses, correction.arm.forward(commands.joints))


def test_postures_from_which_the_arm_approaches_are_in_the_frame_given(correction):
    """A target 120 mm ahead of the tool link is then nearly where the link is desired."""
    arm, joints, target, ahead = correction.arm, correction.learned, np.eye(4), np.eye(4)
    target[2, 3], ahead[2, 3] = 0.12, 0.1
    observations = Observations(joints, arm.forward(joints + 0.01) @ target)
    calibration = calibrate(arm, (OFFSETS,), observations, Frames(np.eye(4), target[None]))
    before = joints[:10]
    goals = calibration.forward(before) @ ahead
    ahead_of_tool = replace(correction, calibration=calibration)
    commands = ahead_of_tool.correct(goals, before, frame="base")
    assert np.abs(calibration.forward(commands.joints) - goals).max() < 1e-7


def test_one_pose_will_do_and_is_reached_from_what_was_learned(correction):
    goal = correction.arm.forward(HOME[None])[0]
    commands = correction.correct(goal, HOME, frame="base")
    reached = correction.calibration.forward(commands.joints)
    assert np.abs(reached - goal).max() < 1e-7
    assert not np.allclose(commands.joints, HOME, atol=1e-3)
    in_loop = correction.command(goal, HOME, frame="base")
    assert np.array_equal(in_loop, commands.joints[0])
    goals = correction.calibration.forward(correction.learned[:5] + 0.02)
    commands = correction.correct(goals, frame="base")
    reached = correction.calibration.forward(commands.joints)
    assert np.abs(reached - goals).max() < 1e-7 and not commands.beyond.any()


def test_an_arm_of_four_joints_turns_its_tool_as_near_as_it_can(load, tmp_path, capsys):
    arm, random = load(SCARA), np.random.default_rng(5)
    joints = random.uniform([-1, 0.3, 0, -2], [1, 1.8, 0.3, 2], (40, 4))
    offsets = np.array([0.01, 0.02, 0.003, -0.02])
    observations = Observations(joints, arm.forward(joints + offsets))
    calibration = calibrate(arm, (OFFSETS,), observations)
    correction = Correction(SCARA.encode(), calibration, joints[35:])  # few to start from
    goals = calibration.forward(joints[:10])
    goals[:, :3, :3] @= Rotation.from_rotvec([0.003, 0, 0]).as_matrix()  # which no joint makes
    commands = correction.correct(goals, frame="base")
    gaps = position_error(calibration.forward(commands.joints), goals)
    assert gaps.max() < 1e-7 and np.allclose(commands.turned, 0.003, rtol=0.05)
    near = commands.joints[0] + np.eye(4)[2]
    with pytest.raises(NotReached, match="only with quill more than 90 deg, or 785 mm if prism"):
        correction.command(goals[0], near, frame="base")
    correction.save(tmp_path / "correction.npz")
    rows = "shoulder [deg],elbow [deg],quill [mm],wrist [deg]\n9,60,-1900,9\n9,60,1900,9\n"
    (tmp_path / "far.csv").write_text(rows)
    words = ["correct", str(tmp_path), f"{tmp_path}/far.csv", f"--out={tmp_path}/commands.csv"]
    assert main(words) == DONE
    assert "with quill 2.01e+03 mm" in (told := capsys.readouterr().err) and "turns by" not in told


@pytest.mark.parametrize("frame", ["base", "instrument"])
def test_the_distance_to_a_pose_out_of_reach_is_reported(correction, frame):
    far = np.diag([1.0, -1.0, -1.0, 1.0])
    far[0, 3] = 9.0
    with pytest.raises(NotReached, match=r"found is 8\d\d\d mm and [\d.]+ deg away"):
        correction.correct(far, frame=frame)


@pytest.mark.parametrize(
    ("poses", "options", "message"),
    [
        (np.zeros((3, 7)), {}, r"poses is 'of shape \(3, 7\)'; expected: an array of .* \(n, 4, 4"),
        (np.full(3, np.nan), {}, "poses is 'an array with NaN or infinity'"),
        ("far", {}, "poses is 'str'; expected: an array of finite numbers"),
        (np.zeros((4, 4)), {}, "poses is 'matrices that are not poses'; expected: poses: a"),
        (np.diag([1.0, 1.0, -1.0, 1.0]), {}, "matrices that are not poses"),
        (np.zeros(3), {"near": np.zeros(6)}, r"near is 'of shape \(6,\)'; expected: .* \(1, 7\)"),
        (np.zeros(3), {"frame": "camera"}, "unknown frame 'camera'"),
        (np.zeros(3), {"target": "ball"}, "unknown target 'ball'"),
        (np.zeros(3), {"target": "the target", "frame": "base"}, "frame is 'base'; expected: inst"),
        (np.zeros((3, 3)), {"target": ["the target"] * 2}, "target is '2 names'; expected: one, o"),
    ],
)
def test_wrong_arrays_are_refused_with_what_was_expected(poses, options, message, correction):
    with pytest.raises(RecalibError, match=message):
        correction.correct(poses, **options)


@pytest.mark.parametrize("poses", [np.eye(3), np.tile(np.eye(4), (2, 1, 1)), np.zeros((0, 3))])
def test_a_command_is_for_one_pose(poses, correction):
    with pytest.raises(RecalibError, match=f"pose is '{len(poses)} poses'; expected: one; try: c"):
        correction.command(poses, None)


def test_a_command_is_beyond_what_was_learned_from_a_twentieth_outside(correction):
    low, high = correction.learned.min(axis=0), correction.learned.max(axis=0)
    outside = correction.learned[:4].copy()
    outside[:, 2] = np.array([low[2], low[2], high[2], high[2]]) + np.array(
        [-0.04, -0.06, 0.04, 0.06]
    ) * (high[2] - low[2])
    goals = correction.calibration.forward(outside)
    commands = correction.correct(goals, outside, frame="base")
    assert np.allclose(commands.joints, outside, atol=1e-6)
    away = 0.06 * (high[2] - low[2])
    assert commands.beyond[:, 2] == pytest.approx([0, away, 0, away], rel=1e-3)


SIGHTS = "calibration/frames/sights"
WRONG_PARTS = {  # a part of the file, and how it is changed
    "another error model": ("calibration/terms", lambda values: values[:-1]),
    "no number": ("calibration/estimate/noise", lambda values: np.nan * values),
    "no angles": ("learned", lambda values: values > 0),
    "no sight": (SIGHTS, lambda values: values[:0]),
    "another target": (SIGHTS, lambda values: values + 1),
    "a target below zero": (SIGHTS, lambda values: values - 1),
    "a target without a number": (SIGHTS, lambda values: 1.0 * values),
}


@pytest.mark.parametrize(("name", "change"), WRONG_PARTS.values(), ids=WRONG_PARTS)
def test_parts_that_do_not_belong_together_are_refused(name, change, small, tmp_path):
    path = tmp_path / "correction.npz"
    path.write_bytes(small)
    with np.load(path) as file:
        arrays = dict(file)
    header = json.loads(str(arrays.pop("header")))
    del header["sha256"]
    arrays[name] = change(arrays[name])
    write_archive(path, header, arrays)
    with pytest.raises(InvalidFile):
        load_correction(path)


@settings(max_examples=60)
@given(st.data())
def test_a_file_that_was_tampered_with_ends_in_a_sentence(small, data):
    """Whatever was replaced in it, also where it was sealed anew; and so with the commands."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "correction.npz"
        path.write_bytes(small)
        spoil(data.draw, path)
        (Path(folder) / "rows.csv").write_text("swing [deg],lift [deg],elbow [deg]\n0,-40,60\n")
        for command in (
            ["correct", folder, f"{folder}/desired.csv"],
            ["next", folder, "--count=2"],
        ):
            with warnings.catch_warnings(action="ignore"):  # of NumPy, about numbers out of range
                assert main([*command, f"--out={folder}/{command[0]}.csv"]) in (DONE, REFUSED)


@pytest.fixture(scope="module")
def small(arm, folder):
    """The file of a correction of a small arm, with a pattern in the residuals."""
    joints = postures(3, 60)
    observations = Observations(joints, arm.forward(joints + 0.01 + 0.02 * np.sin(3 * joints)))
    calibration = calibrate(arm, (OFFSETS,), observations)
    assert calibration.pattern is not None
    urdf = (folder / "arm.urdf").read_bytes()
    Correction(urdf, calibration, joints).save(folder / "small.npz")
    return (folder / "small.npz").read_bytes()
