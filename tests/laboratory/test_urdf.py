import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

from recalib import OFFSETS, Calibration, load_arm
from recalib.identification import Identification
from recalib.identification.model import ErrorModel
from recalib.laboratory.urdf.origins import angles_of, corrected_urdf, with_origins
from recalib.nominal import find_urdf
from tests.nominal.test_arms import ARMS

ROUNDING = 1e-9  # m, rad


def random_calibration(arm, seed: int = 1) -> Calibration:
    """Whatever may be wrong with an arm, as large as the error model expects it."""
    model = ErrorModel(arm, OFFSETS)
    size = len(model.deviations)
    parameters = model.deviations * np.random.default_rng(seed).standard_normal(size)
    estimate = Identification(parameters, np.eye(size), np.ones(1), np.ones(1), 0.0, True)
    return Calibration(model, estimate)


def postures(arm, seed: int = 2) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1.5, 1.5, (20, len(arm.joints)))


def reloaded(text: bytes, tool: str, arm, folder):
    path = folder / "corrected.urdf"
    path.write_bytes(text)
    return load_arm(path, tool, arm.base)


@pytest.mark.parametrize("name", ARMS)
def test_the_corrected_urdf_is_the_calibrated_arm(name, tmp_path):
    """Read by Pinocchio, and by yourdfpy."""
    arm = load_arm(name, ARMS[name][0])
    calibration, joints = random_calibration(arm), postures(arm)
    poses = calibration.forward(joints)
    assert np.abs(poses - arm.forward(joints)).max() > 0.01
    text, tool = corrected_urdf(find_urdf(name).read_bytes(), calibration)
    again = reloaded(text, tool, arm, tmp_path)
    assert again.joints == arm.joints
    assert np.abs(again.forward(joints) - poses).max() < ROUNDING
    other = yourdfpy.URDF.load(str(tmp_path / "corrected.urdf"), load_meshes=False)
    for posture, pose in zip(joints, poses, strict=True):
        other.update_cfg(dict(zip(arm.joints, posture, strict=True)))
        assert np.abs(other.get_transform(tool, arm.base) - pose).max() < ROUNDING


def test_nothing_but_origins_changes():
    """Comments, meshes, transmissions, quotes and blanks stay, to the last byte."""
    name = "ur5_robot.urdf"
    before = find_urdf(name).read_bytes()
    after, tool = corrected_urdf(before, random_calibration(load_arm(name, "tool0")))
    assert tool == "tool0"
    changed = [
        (old, new)
        for old, new in zip(before.splitlines(), after.splitlines(), strict=True)
        if old != new
    ]
    assert len(changed) == 7  # six joints and the one that carries the tool
    assert all(old.strip().startswith(b"<origin ") for old, _ in changed)
    assert all(new.strip().startswith(b"<origin ") for _, new in changed)


def test_where_the_arm_stands_on_another_link_only_what_is_between_changes(tmp_path):
    arm = load_arm("panda.urdf", "panda_hand_tcp", "panda_link2")
    calibration, joints = random_calibration(arm), postures(arm)
    text, tool = corrected_urdf(find_urdf("panda.urdf").read_bytes(), calibration)
    again = reloaded(text, tool, arm, tmp_path)
    assert np.abs(again.forward(joints) - calibration.forward(joints)).max() < ROUNDING
    nominal, below = (
        load_arm(path, "panda_link2") for path in ("panda.urdf", tmp_path / "corrected.urdf")
    )
    assert np.array_equal(below.forward(np.ones((1, 2))), nominal.forward(np.ones((1, 2))))


def test_a_tool_that_hangs_on_a_joint_gets_a_link_of_its_own():
    arm = load_arm("z1.urdf", "link06")
    text, name = corrected_urdf(find_urdf("z1.urdf").read_bytes(), random_calibration(arm))
    assert name == "link06_corrected"
    assert text.count(b'<link name="link06"') == 1


ORIGINS = """<?xml version="1.0"?>
<!-- kept > here: <joint name="a"><origin/></joint> -->
<robot name='r'><joint name="a" type="fixed" ><origin rpy='0 0 0'
  xyz='1 > 0'></origin><parent link="x"/></joint>
  <joint name="b"><parent link="x"/></joint>
  <transmission><joint name="b"><origin xyz="9 9 9"/></joint></transmission>
</robot>"""


def test_origins_are_replaced_or_added_whatever_they_look_like():
    pose = np.eye(4)
    pose[:3, 3] = 1, 2, 3
    text = with_origins(ORIGINS.encode(), {"b": pose, "a": pose}).decode()
    new = '<origin xyz="1 2 3" rpy="0 0 0"/>'
    start = ORIGINS.index("<origin rpy")
    end = ORIGINS.index("<parent")
    expected = ORIGINS[:start] + new + ORIGINS[end:]
    assert text == expected.replace('<joint name="b">', f'<joint name="b">\n    {new}', 1)


@pytest.mark.parametrize("encoding", ["utf-8", "iso-8859-1", "utf-16", "gbk"])
def test_whatever_it_is_encoded_in_every_other_byte_stays(encoding):
    letters = "机" if encoding == "gbk" else "ä"
    text = ORIGINS.replace('version="1.0"', f'version="1.0" encoding="{encoding}"')
    text = text.replace("kept", letters) + f"<!-- {letters} </robot> -->"
    added = f"<!-- {letters} -->"
    changed = with_origins(text.encode(encoding), {"a": np.eye(4)}, added).decode(encoding)
    start, end = text.index("<origin rpy"), text.index("<parent")
    new = '<origin xyz="0 0 0" rpy="0 0 0"/>'
    assert changed == (text[:start] + new + text[end:]).replace("</robot>", f"{added}</robot>", 1)


@pytest.mark.parametrize("pitch", [0.3, np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-9, 1.57079632679])
def test_angles_give_the_turn_back_even_where_yaw_and_roll_are_one(pitch):
    pose = np.eye(4)
    pose[:3, :3] = pin.rpy.rpyToMatrix(0.4, pitch, -2.1)
    assert np.abs(pin.rpy.rpyToMatrix(*angles_of(pose)) - pose[:3, :3]).max() < 1e-14
