"""What damages do to an arm: to its links, its base, its encoders and its gears."""

import numpy as np
import pinocchio as pin
import pytest

from recalib import (
    Backlash,
    BaseShift,
    EccentricGear,
    EncoderShift,
    InvalidSetting,
    LinkBend,
    LinkShortening,
    Sag,
    UnknownName,
    apply,
)
from recalib.nominal import link_end

ANGLES = np.random.default_rng(3).uniform(-1, 1, (20, 6))


def test_no_damage_is_the_nominal_arm_which_stays_whole(robot):
    before = robot.arm.forward(ANGLES)
    np.testing.assert_allclose(apply(robot, []).forward(ANGLES), before, rtol=0, atol=1e-12)
    links = [LinkShortening(link, 0.01) for link in ("forearm_link", "wrist_3_link")]
    apply(robot, [*links, BaseShift((1, 1, 1), (1, 1, 1))])
    assert np.array_equal(robot.arm.forward(ANGLES), before)


def test_the_whole_robot_moved_moves_every_pose(robot):
    turn = pin.rpy.rpyToMatrix(0.1, -0.2, 0.3)
    shift = pin.SE3(turn, np.array([0.01, -0.02, 0.03])).homogeneous
    damaged = apply(robot, [BaseShift(translate=(0.01, -0.02, 0.03), rotate=(0.1, -0.2, 0.3))])
    assert np.allclose(damaged.forward(ANGLES), shift @ robot.arm.forward(ANGLES))
    damages = [BaseShift(rotate=(0, 0, np.pi / 2)), BaseShift(translate=(1, 0, 0))]
    moved = apply(robot, damages).forward(ANGLES)[:, :3, 3]
    turned = apply(robot, damages[:1]).forward(ANGLES)[:, :3, 3]
    assert np.allclose(moved - turned, [1, 0, 0])


WHOLE = {"forearm_link": 0.5723, "upper_arm_link": np.hypot(0.1719, 0.612), "wrist_3_link": 0.0922}


@pytest.mark.parametrize(("link", "whole"), WHOLE.items())
def test_a_link_loses_its_length_and_nothing_else_changes(robot, link, whole):
    damaged = apply(robot, [LinkShortening(link, 0.04)]).forward(ANGLES)
    nominal = robot.arm.forward(ANGLES)
    assert np.allclose(damaged[:, :3, :3], nominal[:, :3, :3])
    # The tool moves by the length taken off, whatever the arm's posture
    assert np.allclose(np.linalg.norm(damaged[:, :3, 3] - nominal[:, :3, 3], axis=1), 0.04)
    with pytest.raises(InvalidSetting, match=f"{whole * 100:.2f} cm, its length"):
        apply(robot, [LinkShortening(link, whole + 1e-6)])


@pytest.mark.parametrize(
    ("link", "before", "after"),
    [
        ("upper_arm_link", [0, -0.1719, 0.612], [0, -0.1719, 0.572]),
        ("wrist_3_link", [0, 0.0922, 0], [0, 0.0522, 0]),
    ],
)
def test_a_link_may_lose_its_length_along_an_axis(robot, link, before, after):
    damaged = apply(robot, [LinkShortening(link, 0.04, "axis")])
    ends = [link_end(arm, robot.links[link]).translation for arm in (robot.arm, damaged.arm)]
    assert np.allclose(ends, [before, after])
    with pytest.raises(InvalidSetting, match=r"61\.2 cm.*; expected: .* below (61.20|9.22) cm"):
        apply(robot, [LinkShortening(link, 0.612, "axis")])
    with pytest.raises(UnknownName, match="expected: axis or line"):
        LinkShortening(link, 0.04, "z")


def test_an_encoder_shift_is_an_offset_of_its_joint(robot):
    damaged = apply(robot, [EncoderShift("elbow_joint", 0.07), EncoderShift("elbow_joint", 0.01)])
    assert np.allclose(damaged.forward(ANGLES), robot.arm.forward(ANGLES + 0.08 * np.eye(6)[2]))


@pytest.mark.parametrize(
    ("damage", "twice"),
    [
        (BaseShift((1.0, 2.0, 0.0)), BaseShift((2.0, 4.0, 0.0))),
        (EccentricGear("elbow_joint", 0.1, 0.3), EccentricGear("elbow_joint", 0.2, 0.3)),
        (LinkBend("forearm_link", 0.1, 0.3), LinkBend("forearm_link", 0.2, 0.3)),
    ],
)
def test_a_damage_twice_as_large_has_twice_its_amounts(damage, twice):
    assert damage.scaled(2) == twice
    assert damage.scaled(1) == damage


@pytest.mark.parametrize("amount", [np.nan, np.inf, -np.inf, 3.2, -3.2])
def test_amounts_beyond_the_bounds_of_their_kind_are_refused(amount):
    with pytest.raises(InvalidSetting, match=r"EncoderShift\.shift is .*: an angle from"):
        EncoderShift("elbow_joint", amount)
    with pytest.raises(InvalidSetting, match=r"BaseShift\.rotate is .* -180 to 180 deg, in rad$"):
        BaseShift(rotate=(0.0, 0.0, amount))
    with pytest.raises(InvalidSetting, match=r"shorten is -0\.01; .* from 0 to 100 m, in m"):
        LinkShortening("forearm_link", -0.01)
    with pytest.raises(InvalidSetting, match=r"gap is 3\.2; expected: an angle from 0 to 180 deg"):
        Backlash("elbow_joint", 3.2)


SHOULDER = "shoulder_lift_joint"


@pytest.fixture
def angles(robot) -> np.ndarray:
    return robot.home + np.random.default_rng(1).uniform(-0.5, 0.5, (20, 6))


def deflection(robot, damage, angles) -> np.ndarray:
    return apply(robot, [damage]).standing(angles) - angles


def test_a_gear_moves_its_joint_by_a_sine_and_a_load_by_its_compliance(robot, angles):
    """But for a vertical axis, which has no load and rests in the middle of its gap."""
    moved = deflection(robot, EccentricGear("elbow_joint", 0.01, 0.3), angles)
    assert np.allclose(moved[:, 2], 0.01 * np.sin(angles[:, 2] + 0.3))
    assert np.allclose(np.delete(moved, 2, axis=1), 0)
    moved = deflection(robot, Sag("elbow_joint", 2e-4), angles)
    torques = robot.arm.gravity_torque(angles)
    assert np.allclose(moved, -2e-4 * torques * np.eye(6)[2], atol=1e-15)
    assert not deflection(robot, Backlash("shoulder_pan_joint", 0.004), angles).any()


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
