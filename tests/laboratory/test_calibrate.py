"""Frames that are known, several targets, and a ball in sockets, on a small arm that is bent."""

import numpy as np
import pytest

from recalib.errors import InvalidFile, InvalidSetting
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.propose import propose
from recalib.laboratory.summary import summary
from recalib.nominal.arms import load_arm
from recalib.nominal.chain import Chain
from tests.laboratory.test_command_line import ARM, MIDDLE, NOISE, OFFSETS, SEEN, write

ROWS = 30
INSTRUMENT = """
[instrument]
position = ["1 m", "0 m", "0 m"]
[target]
position = ["0 mm", "0 mm", "50 mm"]
"""
DISTANCE = """
[[distance]]
sockets = ["{}", "right"]
length = "300 mm"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("calibrate")
    (folder / "arm.urdf").write_text(ARM)
    return folder


@pytest.fixture(scope="module")
def arm(folder):
    return load_arm(folder / "arm.urdf")


@pytest.fixture(scope="module")
def joints():
    return MIDDLE + SEEN * np.random.default_rng(12).uniform(-1, 1, (ROWS, 3))


def in_degrees(arm, joints: np.ndarray) -> dict:
    return {f"{joint} [deg]": np.degrees(joints[:, i]) for i, joint in enumerate(arm.joints)}


def measured(arm, joints: np.ndarray, points: np.ndarray) -> dict:
    """Points of the tool (n, 3) [m], in the frame of an instrument at x = 1 m."""
    poses = arm.forward(joints + OFFSETS)
    noise = NOISE * np.random.default_rng(13).standard_normal(points.shape)
    places = (poses[:, :3, :3] @ points[..., None])[..., 0] + poses[:, :3, 3] + noise
    places -= [1, 0, 0]
    return {f"{axis} [m]": places[:, index] for index, axis in enumerate("xyz")}


def test_frames_that_are_known_leave_base_and_tool_to_the_arm(arm, joints, folder):
    (folder / "known.toml").write_text(INSTRUMENT)
    columns = in_degrees(arm, joints) | measured(arm, joints, np.full((ROWS, 3), [0, 0, 0.05]))
    write(folder / "known.csv", columns)
    result = calibrate_arm(folder / "arm.urdf", folder / "known.csv", folder / "known.toml")
    assert not result.frames.base_unknown and not result.frames.targets_unknown
    assert result.worthwhile
    tests = MIDDLE + 0.8 * SEEN * np.random.default_rng(14).uniform(-1, 1, (20, 3))
    target = np.array([0, 0, 0.05, 1])
    gap = (result.calibration.forward(tests) - arm.forward(tests + OFFSETS)) @ target
    assert np.linalg.norm(gap, axis=1).mean() < 3 * NOISE


@pytest.mark.parametrize("part", ["instrument", "target"])
def test_one_frame_alone_may_be_known(part, arm, joints, folder):
    both = INSTRUMENT[: INSTRUMENT.index("[target]")], INSTRUMENT[INSTRUMENT.index("[target]") :]
    (folder / "one.toml").write_text(both[part == "target"])
    point = np.array([0, 0, 0.05])
    columns = in_degrees(arm, joints) | measured(arm, joints, np.full((ROWS, 3), point))
    nominal = arm.forward(joints) @ [*point, 1] - [1, 0, 0, 0]
    columns |= {f"{axis}_nominal [m]": nominal[:, index] for index, axis in enumerate("xyz")}
    write(folder / "one.csv", columns)
    result = calibrate_arm(folder / "arm.urdf", folder / "one.csv", folder / "one.toml")
    assert result.worthwhile
    assert (result.frames.base_unknown, result.frames.targets_unknown) == (
        (False, True) if part == "instrument" else (True, False)
    )
    told = str(result.beside)
    assert "a tool point at (0, 0, 50) mm" in told and "the base moved by (-1000, 0, 0) mm" in told
    frames = result.calibration.frames
    assert np.allclose(frames.base[:3, 3], [-1, 0, 0], atol=0.02)
    assert np.allclose(frames.targets[0, :3, 3], point, atol=0.02)


def test_a_ball_whose_place_is_known_needs_no_instrument_either(in_sockets, folder):
    (folder / "ball.toml").write_text('[target]\nposition = ["0 mm", "0 mm", "0 mm"]\n')
    result = calibrate_arm("panda.urdf", in_sockets, folder / "ball.toml", tool="panda_hand_tcp")
    assert np.array_equal(result.calibration.frames.targets[0], np.eye(4))
    (folder / "ball.toml").write_text(INSTRUMENT)
    with pytest.raises(InvalidFile, match="has an instrument; a ball in sockets needs none"):
        calibrate_arm("panda.urdf", in_sockets, folder / "ball.toml", tool="panda_hand_tcp")


def test_targets_have_places_of_their_own(arm, joints, folder):
    places = {"left": [0.0, 0.1, 0.0], "right": [0.0, -0.1, 0.05]}
    names = ["left", "right"] * (ROWS // 2)
    points = np.array([places[name] for name in names])
    columns = in_degrees(arm, joints) | measured(arm, joints, points) | {"target": names}
    write(folder / "targets.csv", columns)
    result = calibrate_arm(folder / "arm.urdf", folder / "targets.csv")
    assert result.targets == ("left", "right")
    left, right = result.calibration.frames.targets[:, :3, 3]
    apart = np.subtract(places["left"], places["right"])
    assert np.linalg.norm(left - right) == pytest.approx(np.linalg.norm(apart), abs=2e-3)


@pytest.fixture(scope="module")
def in_sockets(folder):
    """A seven-jointed arm of which one joint is off, in two sockets."""
    arm = load_arm("panda.urdf", "panda_hand_tcp")
    random = np.random.default_rng(15)
    joints = np.array([0, 0.2, 0, -2, 0, 2.2, 0.8]) + random.uniform(-0.6, 0.6, (40, 7))
    names = ["left", "right"] * 20
    centres = {"left": [0.45, -0.15, 0.3], "right": [0.45, 0.15, 0.3]}
    poses = arm.forward(joints)
    poses[:, :3, 3] = [centres[name] for name in names]
    joints, left = Chain.of(arm).solve(poses, joints)
    assert left.max() < 1e-9
    joints[:, 3] -= 0.02
    write(folder / "sockets.csv", in_degrees(arm, joints) | {"socket": names})
    return folder / "sockets.csv"


def test_a_ball_in_sockets_needs_no_instrument(in_sockets, folder):
    (folder / "apart.toml").write_text(DISTANCE.format("left"))
    result = calibrate_arm("panda.urdf", in_sockets, folder / "apart.toml", tool="panda_hand_tcp")
    one, other = result.calibration.frames.sockets
    assert np.linalg.norm(one - other) == pytest.approx(0.3, abs=1e-3)
    assert result.worthwhile and result.sockets == ("left", "right")
    assert "a ball in sockets shows errors there" in summary(result)
    with pytest.raises(InvalidSetting, match="candidates is missing; valid: postures in which"):
        propose(result.correction, 3)


def test_a_distance_between_sockets_that_are_not_there_is_refused(in_sockets, folder):
    (folder / "wrong.toml").write_text(DISTANCE.format("middle"))
    with pytest.raises(InvalidFile, match="names socket 'middle'; the table has left, right"):
        calibrate_arm("panda.urdf", in_sockets, folder / "wrong.toml", tool="panda_hand_tcp")
