"""What other programs read: URDFs, also of tables of links, and files of Universal Robots."""

import numpy as np
import pinocchio as pin
import pytest
import yaml
import yourdfpy

from recalib import OFFSETS, Calibration, Row, arm_of_table, load_arm
from recalib.identification import Identification
from recalib.identification.model import ErrorModel
from recalib.laboratory.command_line import main
from recalib.laboratory.urdf.dh_table import read_rows, urdf_of
from recalib.laboratory.urdf.origins import angles_of, corrected_urdf, with_origins
from recalib.laboratory.urdf.universal_robots import LINKS, kinematics_yaml
from recalib.nominal import CONVENTIONS, find_urdf
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


@pytest.mark.parametrize(("name", "tool"), [one[:2] for one in ARMS])
def test_the_corrected_urdf_is_the_calibrated_arm(name, tool, tmp_path):
    """Read by Pinocchio, and by yourdfpy."""
    arm = load_arm(name, tool)
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
    both = "panda.urdf", tmp_path / "corrected.urdf"
    nominal, below = (load_arm(path, "panda_link2") for path in both)
    assert np.array_equal(below.forward(np.ones((1, 2))), nominal.forward(np.ones((1, 2))))
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


TABLE = """joint,a [mm],alpha [deg],d [cm],theta [rad],kind
waist,10,-90,40,0.1,revolute
shoulder,0,90,15,0,revolute
boom,0,0,0,0,prismatic
"wrist & co",-25,30,5,-0.3,revolute
"""


@pytest.fixture
def path(tmp_path):
    (path := tmp_path / "links.csv").write_text(TABLE)
    return path


def test_a_table_is_read_in_its_units(path):
    rows = read_rows(path)
    assert rows[0] == Row("waist", 0.01, -np.pi / 2, 0.4, 0.1)
    assert [row.slides for row in rows] == [False, False, True, False]
    path.write_text("joint,a [mm],alpha [deg],d [cm],theta [rad]\nwaist,10,-90,40,0.1\n")
    assert read_rows(path) == rows[:1]


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_urdf_of_a_table_is_its_arm(convention, path, tmp_path, capsys):
    out = tmp_path / "arm.urdf"
    assert main(["urdf", str(path), "--convention", convention, "--out", str(out)]) == 0
    expected = f"{out}: waist, shoulder, boom, wrist & co, from base to tool\n"
    assert capsys.readouterr().out == expected
    arm, again = arm_of_table(read_rows(path), convention), load_arm(out)
    assert out.read_text() == urdf_of(arm)
    assert (again.joints, again.tool, again.base) == (arm.joints, arm.tool, arm.base)
    assert again.massless and np.isinf(again.model.upperPositionLimit).all()
    angles = np.random.default_rng(0).uniform(-2, 2, (10, 4))
    np.testing.assert_allclose(again.forward(angles), arm.forward(angles), rtol=0, atol=1e-12)


# As the manufacturer publishes them, Denavit and Hartenberg's: d1, a2, a3, d4, d5, d6 [m].
PUBLISHED = {
    "ur5_robot.urdf": (0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823),
    "ur10_robot.urdf": (0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922),
}


def origins(calibration) -> list[np.ndarray]:
    read = yaml.safe_load(kinematics_yaml(calibration))["kinematics"]
    assert [*read] == [*LINKS, "hash"]
    poses = []
    for link in LINKS:
        numbers = read[link]
        turn = pin.rpy.rpyToMatrix(*(numbers[angle] for angle in ("roll", "pitch", "yaw")))
        place = np.array([numbers[axis] for axis in "xyz"])
        poses.append(pin.SE3(turn, place).homogeneous)
    return poses


def flange(origins: list[np.ndarray], joints: np.ndarray) -> np.ndarray:
    """Of ur_description: its base is turned by half a turn, its joints turn about z."""
    pose = np.diag([-1.0, -1.0, 1.0, 1.0])
    for origin, angle in zip(origins, joints, strict=True):
        turn = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, angle), np.zeros(3)).homogeneous
        pose = pose @ origin @ turn
    return pose


@pytest.mark.parametrize("name", PUBLISHED)
def test_without_errors_it_is_as_published(name):
    calibration = random_calibration(load_arm(name, "tool0"))
    calibration.estimate.parameters[:] = 0
    shoulder, upper, forearm, *wrist = origins(calibration)
    found = [shoulder[2, 3], forearm[0, 3], wrist[0][0, 3], wrist[0][2, 3]]
    found += [-wrist[1][1, 3], wrist[2][1, 3]]
    assert np.allclose(found, PUBLISHED[name], atol=1e-9)
    assert np.allclose(upper[:3, :3], pin.rpy.rpyToMatrix(np.pi / 2, 0.0, 0.0), atol=1e-9)
    assert np.allclose(wrist[2][:3, :3], pin.rpy.rpyToMatrix(np.pi / 2, np.pi, np.pi), atol=1e-9)


def test_it_moves_as_the_calibrated_arm_but_for_what_is_bent_behind_the_last_joint():
    arm = load_arm("ur10_robot.urdf", "tool0")
    calibration = random_calibration(arm)
    links, joints = origins(calibration), postures(arm)
    own = calibration.forward(joints)
    gaps = [np.linalg.inv(flange(links, q)) @ pose for q, pose in zip(joints, own, strict=True)]
    assert np.ptp(gaps, axis=0).max() < 1e-9
    assert np.abs(gaps[0] - np.eye(4)).max() < 0.2  # what the tool's own twist does
    calibration.estimate.parameters[:] = 0
    for before, after in zip(origins(calibration), links, strict=True):
        assert np.linalg.norm(after[:3, 3] - before[:3, 3]) < 0.2


def test_another_arm_has_none_and_so_has_one_with_a_joint_of_another_name(tmp_path):
    assert kinematics_yaml(random_calibration(load_arm("panda.urdf", "panda_hand_tcp"))) is None
    text = find_urdf("ur10_robot.urdf").read_text()
    (tmp_path / "other.urdf").write_text(text.replace("wrist_2_joint", "wrist_two"))
    other = load_arm(tmp_path / "other.urdf", "tool0")
    assert other.joints[4] == "wrist_two" and kinematics_yaml(random_calibration(other)) is None
