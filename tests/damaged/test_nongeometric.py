import numpy as np
import pytest

from recalib import Backlash, EccentricGear, EncoderShift, Sag, apply

SHOULDER = "shoulder_lift_joint"


@pytest.fixture
def angles(robot) -> np.ndarray:
    return robot.home + np.random.default_rng(1).uniform(-0.5, 0.5, (20, 6))


def deflection(robot, damage, angles) -> np.ndarray:
    return apply(robot, [damage]).standing(angles) - angles


def test_eccentric_gear_moves_its_joint_by_a_sine(robot, angles):
    moved = deflection(robot, EccentricGear("elbow_joint", 0.01, 0.3), angles)
    assert np.allclose(moved[:, 2], 0.01 * np.sin(angles[:, 2] + 0.3))
    assert np.allclose(np.delete(moved, 2, axis=1), 0)


def test_a_joint_sags_by_its_compliance_times_its_torque(robot, angles):
    moved = deflection(robot, Sag("elbow_joint", 2e-4), angles)
    torques = robot.arm.gravity_torque(angles)
    assert np.allclose(moved, -2e-4 * torques * np.eye(6)[2], atol=1e-15)


def test_sagging_lowers_the_arm(robot, angles):
    for joint in robot.joints[1:4]:
        before, after = (
            apply(robot, damages).forward(angles)[:, 2, 3] for damages in ([], [Sag(joint, 1e-4)])
        )
        assert np.all(after < before)


@pytest.mark.parametrize(("joint", "heavy"), [(SHOULDER, True), ("wrist_1_joint", False)])
def test_backlash_is_half_the_gap_with_gravity_however_little_that_is(robot, angles, joint, heavy):
    """Whichever way it pulls."""
    index = robot.joints.index(joint)
    angles = np.concatenate([angles, angles + np.pi * np.eye(6)[robot.joints.index(SHOULDER)]])
    moved = deflection(robot, Backlash(joint, 0.004), angles)[:, index]
    torques = robot.arm.gravity_torque(angles)[:, index]
    assert (np.abs(torques) > 1).all() == heavy, "N m"
    assert {*np.sign(torques)} == {-1, 1}
    assert np.allclose(moved, -0.002 * np.sign(torques))


def test_deflections_start_from_where_the_encoders_leave_the_joints(robot, angles):
    """Torques, too: so that the order of damages does not matter."""
    shift = EncoderShift("elbow_joint", 0.3)
    both = apply(robot, [shift, Sag("elbow_joint", 1e-4), EccentricGear("elbow_joint", 0.01)])
    shifted = angles + 0.3 * np.eye(6)[2]
    sag = -1e-4 * robot.arm.gravity_torque(shifted)[:, 2]
    expected = shifted[:, 2] + sag + 0.01 * np.sin(shifted[:, 2])
    assert np.allclose(both.standing(angles)[:, 2], expected, atol=1e-14)


def test_a_vertical_axis_has_no_load_and_rests_in_the_middle_of_its_gap(robot, angles):
    assert not deflection(robot, Backlash("shoulder_pan_joint", 0.004), angles).any()
