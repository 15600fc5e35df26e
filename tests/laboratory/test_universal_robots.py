import numpy as np
import pinocchio as pin
import pytest
import yaml

from recalib import load_arm
from recalib.laboratory.urdf.universal_robots import LINKS, kinematics_yaml
from recalib.nominal import find_urdf
from tests.laboratory.test_urdf import postures, random_calibration

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
    its, joints = origins(calibration), postures(arm)
    own = calibration.forward(joints)
    beside = [np.linalg.inv(flange(its, q)) @ pose for q, pose in zip(joints, own, strict=True)]
    assert np.ptp(beside, axis=0).max() < 1e-9
    assert np.abs(beside[0] - np.eye(4)).max() < 0.2  # what the tool's own twist does


def test_parallel_axes_throw_no_frame_far_away():
    calibration = random_calibration(load_arm("ur10_robot.urdf", "tool0"))
    moved = origins(calibration)
    calibration.estimate.parameters[:] = 0
    for before, after in zip(origins(calibration), moved, strict=True):
        assert np.linalg.norm(after[:3, 3] - before[:3, 3]) < 0.2


def test_another_arm_has_none_and_so_has_one_with_a_joint_of_another_name(tmp_path):
    assert kinematics_yaml(random_calibration(load_arm("panda.urdf", "panda_hand_tcp"))) is None
    text = find_urdf("ur10_robot.urdf").read_text()
    (tmp_path / "other.urdf").write_text(text.replace("wrist_2_joint", "wrist_two"))
    other = load_arm(tmp_path / "other.urdf", "tool0")
    assert other.joints[4] == "wrist_two" and kinematics_yaml(random_calibration(other)) is None
