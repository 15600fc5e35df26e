"""Arms as they are loaded: their joints, points and links, and what is said in loading."""

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from recalib import InvalidFile, InvalidSetting, UnsuitableRobot, load_arm
from recalib.nominal import STDERR, UrdfFile, caught_messages, find_urdf
from tests.arms import GANTRY, LIBRARY, SCARA
from tests.nominal.test_newton import standing

ARMS = [(one["urdf"], one["tool"], len(one["home"])) for one in LIBRARY if "home" in one]
ARMS += [("so100.urdf", "gripper", 5), ("TwoDofs.urdf", "Tip", 2)]


@pytest.mark.parametrize(("name", "tool", "count"), ARMS)
def test_an_arm_of_example_robot_data_has_the_joints_that_move_its_tool(name, tool, count):
    arm = load_arm(name, tool)
    assert len(arm.joints) == arm.model.nq == arm.model.nv == len(arm.axes) == count
    assert list(np.flatnonzero(arm.slides)) == ([0] if name == "tiago.urdf" else [])
    poses, jacobians = arm.forward_and_jacobian(np.zeros((2, count)))
    assert poses.shape == (2, 4, 4) and jacobians.shape == (2, 6, count)
    assert arm.gravity_torque(np.zeros((2, count))).shape == (2, count)
    assert not arm.massless


def test_a_scara_moves_as_its_closed_form_says(load):
    arm = load(SCARA)
    assert (arm.base, arm.tool) == ("base", "link_5")
    assert arm.joints == ("shoulder", "elbow", "quill", "wrist")
    assert arm.slides.tolist() == [False, False, True, False]
    assert arm.model.upperPositionLimit.tolist() == [2, np.inf, 2, 2]
    shoulder, elbow, quill, wrist = 0.3, 4.0, 0.12, -0.7
    both = shoulder + elbow
    pose = arm.forward(np.array([[shoulder, elbow, quill, wrist]]))[0]
    assert np.allclose(pose[0, 3], 0.35 * np.cos(shoulder) + 0.25 * np.cos(both))
    assert np.allclose(pose[1, 3], 0.35 * np.sin(shoulder) + 0.25 * np.sin(both))
    assert np.allclose(pose[2, 3], 0.4 - quill - 0.15)
    assert np.allclose(pose[:2, 0], [np.cos(both + wrist), np.sin(both + wrist)])


def test_one_link_with_a_mass_is_enough_for_gravity_and_limits_may_hold_a_joint(load):
    light = load(SCARA)
    assert light.massless
    assert not load(SCARA.replace('mass value="0.0"', 'mass value="2"', 1)).massless
    arm = load(SCARA.replace('lower="-2"', 'lower="2"', 1))
    assert arm.model.lowerPositionLimit[0] == arm.model.upperPositionLimit[0] == 2


def test_a_gantry_adds_its_slides_along_their_axes(load):
    arm = load(GANTRY)
    x, y, z = 0.3, -0.2, 0.5
    assert arm.slides.all() and np.allclose(arm.axes[2], [0, 0.6, 0.8])
    assert np.allclose(arm.forward(np.array([[x, y, z]]))[0, :3, 3], [x, y + 0.6 * z, 1 + 0.8 * z])


@pytest.mark.parametrize("base", ["panda_link2", "panda_link4"])
def test_poses_are_in_the_frame_of_the_base_and_gravity_stays_down(base):
    whole, part = load_arm("panda.urdf", "panda_hand"), load_arm("panda.urdf", "panda_hand", base)
    under = len(whole.joints) - len(part.joints)
    assert part.joints == whole.joints[under:] and part.base == base
    angles = np.random.default_rng(0).uniform(-1, 1, (3, len(part.joints)))
    padded = np.pad(angles, ((0, 0), (under, 0)))
    link = load_arm("panda.urdf", base).forward(np.zeros((1, under)))
    assert np.allclose(link @ part.forward(angles), whole.forward(padded))
    assert np.allclose(part.gravity_torque(angles), whole.gravity_torque(padded)[:, under:])


def test_a_joint_that_is_called_like_a_link_keeps_its_name():
    assert load_arm("so100.urdf", "jaw").joints[-1] == "gripper"


def test_an_installed_description_is_found_by_its_name(monkeypatch, tmp_path):
    (path := tmp_path / "scara.urdf").write_text(SCARA)
    monkeypatch.setitem(sys.modules, "robot_descriptions", SimpleNamespace())
    name = "robot_descriptions.scara_description"
    monkeypatch.setitem(sys.modules, name, SimpleNamespace(URDF_PATH=str(path)))
    assert len(load_arm("scara_description").joints) == 4
    with pytest.raises(InvalidSetting, match=r"'arm_description'; .* has to be installed"):
        load_arm("arm_description")


def test_what_hangs_on_fixed_joints_alone_is_no_end_of_the_arm(load):
    """Such as a camera on the base."""
    camera = '<link name="camera"/><joint name="mount" type="fixed"><parent link="base"/>'
    with_camera = GANTRY.replace("</robot>", f'{camera}<child link="camera"/></joint></robot>')
    assert load(with_camera).tool == load(GANTRY).tool


def test_what_is_still_to_be_expanded_is_refused_whatever_its_name(load):
    macro = '<xacro:macro xmlns:xacro="http://ros.org/wiki/xacro" name="m"/></robot>'
    with pytest.raises(UnsuitableRobot, match="is a xacro file; try: the output of `xacro"):
        load(GANTRY.replace("</robot>", macro))


def test_a_file_of_ones_own_comes_before_one_of_a_package(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    packaged = find_urdf("panda.urdf")
    assert packaged.is_absolute() and UrdfFile.read("panda.urdf").origin.startswith(
        "panda.urdf of the package example-robot-data (sha256 63792d2679f2"
    )
    own = packaged.read_text().replace("0 0 0.333", "0 0 0.999")
    (tmp_path / "panda.urdf").write_text(own)
    assert find_urdf("panda.urdf") == Path("panda.urdf")
    assert load_arm("panda.urdf", "panda_link8").model.jointPlacements[1].translation[2] == 0.999
    assert UrdfFile.read("panda.urdf").origin.startswith("panda.urdf (sha256 ")


def test_what_is_no_file_of_ones_own_is_not_passed_over(tmp_path, monkeypatch):
    """A link to nothing is meant; a folder may be a package's that has a description of its own."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "panda.urdf").symlink_to("gone.urdf")
    with pytest.raises(InvalidFile, match=r"panda.urdf: No such file"):
        load_arm("panda.urdf", "panda_link8")
    (tmp_path / "panda.urdf").unlink()
    (tmp_path / "panda.urdf").mkdir()
    assert find_urdf("panda.urdf").is_absolute()
    with pytest.raises(InvalidFile, match="it is a folder; expected: a file"):
        load_arm(tmp_path)


@pytest.mark.parametrize("name", ["ur10_robot.urdf", "tiago.urdf"])
def test_a_skeleton_goes_from_the_base_over_the_joints_to_the_tool(name):
    """Rotating a joint leaves where it and those before it are; the tool is where it is."""
    arm, posture = standing(name)
    angles = posture + np.random.default_rng(1).uniform(-0.1, 0.1, (3, len(arm.joints)))
    points = arm.skeleton(angles)
    joints = len(arm.joints)
    assert points.shape == (3, joints + 2, 3) and not points[:, 0].any()
    assert np.allclose(points[:, -1], arm.forward(angles)[:, :3, 3])
    for joint in np.flatnonzero(~arm.slides):
        moved = arm.skeleton(angles + 0.3 * (np.arange(joints) == joint))
        assert np.allclose(moved[:, : joint + 2], points[:, : joint + 2])
    assert not np.allclose(arm.skeleton(angles + 0.3)[:, 2:], points[:, 2:], atol=0.01)


def test_lines_are_caught_and_the_next_ones_are_written_again_if_stderr_is_open(capfd):
    with caught_messages() as lines:
        os.write(STDERR, b"Error: one\n two\n")
    os.write(STDERR, b"three\n")
    assert lines == ["Error: one", " two"]
    assert capfd.readouterr().err == "three\n"
    before = os.dup(STDERR)
    os.close(STDERR)
    try:
        with caught_messages() as lines:
            pass
    finally:
        os.dup2(before, STDERR)
        os.close(before)
    assert lines == []
