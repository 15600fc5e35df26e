import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import (
    Backlash,
    BaseShift,
    EccentricGear,
    EncoderShift,
    InvalidSetting,
    LinkBend,
    LinkShortening,
    UnknownName,
    apply,
)
from recalib.damaged import Imperfection
from recalib.nominal import link_end

ANGLES = np.random.default_rng(3).uniform(-1, 1, (20, 6))


def test_no_damage_is_the_nominal_arm(robot):
    intact = apply(robot, []).forward(ANGLES)
    np.testing.assert_allclose(intact, robot.arm.forward(ANGLES), rtol=0, atol=1e-12)


def test_the_whole_robot_moved_moves_every_pose(robot):
    shift = np.eye(4)
    shift[:3, :3] = Rotation.from_euler("xyz", [0.1, -0.2, 0.3]).as_matrix()
    shift[:3, 3] = 0.01, -0.02, 0.03
    damaged = apply(robot, [BaseShift(translate=(0.01, -0.02, 0.03), rotate=(0.1, -0.2, 0.3))])
    assert np.allclose(damaged.forward(ANGLES), shift @ robot.arm.forward(ANGLES))


def test_base_shifts_follow_each_other(robot):
    damages = [BaseShift(rotate=(0, 0, np.pi / 2)), BaseShift(translate=(1, 0, 0))]
    moved = apply(robot, damages).forward(ANGLES)[:, :3, 3]
    turned = apply(robot, damages[:1]).forward(ANGLES)[:, :3, 3]
    assert np.allclose(moved - turned, [1, 0, 0])


@pytest.mark.parametrize(
    ("link", "whole"),
    [
        ("forearm_link", 0.5723),
        ("upper_arm_link", np.hypot(0.1719, 0.612)),
        ("wrist_3_link", 0.0922),
    ],
)
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
    arms = robot.arm, damaged.arm
    ends = [link_end(arm.model, "tool0", robot.links[link]).translation for arm in arms]
    assert np.allclose(ends, [before, after])
    with pytest.raises(
        InvalidSetting, match=r"61\.2 cm.*; expected: from 0 to below (61.20|9.22) cm"
    ):
        apply(robot, [LinkShortening(link, 0.612, "axis")])
    with pytest.raises(UnknownName, match="expected: axis or line"):
        LinkShortening(link, 0.04, "z")


def test_an_encoder_shift_is_an_offset_of_its_joint(robot):
    damaged = apply(robot, [EncoderShift("elbow_joint", 0.07), EncoderShift("elbow_joint", 0.01)])
    assert np.allclose(damaged.forward(ANGLES), robot.arm.forward(ANGLES + 0.08 * np.eye(6)[2]))


def test_the_nominal_robot_stays_whole(robot):
    before = robot.arm.forward(ANGLES)
    apply(
        robot,
        [
            LinkShortening("forearm_link", 0.04),
            LinkShortening("wrist_3_link", 0.01),
            BaseShift((1, 1, 1), (1, 1, 1)),
        ],
    )
    assert np.array_equal(robot.arm.forward(ANGLES), before)


@pytest.mark.parametrize("damage", [LinkShortening("forearm", 0.01), EncoderShift("elbow", 0.01)])
def test_unknown_names_are_refused_with_the_known_ones(robot, damage):
    with pytest.raises(UnknownName, match="forearm_link|elbow_joint"):
        apply(robot, [damage])


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


def test_no_two_kinds_have_the_same_words():
    with pytest.raises(TypeError, match="Dent: LinkBend has bend, too"):

        class Dent(Imperfection, words=("bend",)):
            """A kind that a reader would take for a bent link."""


@pytest.mark.parametrize("amount", [np.nan, np.inf, -np.inf, 3.2, -3.2])
def test_angles_beyond_half_a_turn_are_refused(amount):
    with pytest.raises(InvalidSetting, match=r"EncoderShift\.shift is .*: an angle from"):
        EncoderShift("elbow_joint", amount)
    with pytest.raises(InvalidSetting, match=r"BaseShift\.rotate is .* -180 to 180 deg, in rad$"):
        BaseShift(rotate=(0.0, 0.0, amount))


def test_amounts_of_each_kind_have_bounds_of_their_own():
    with pytest.raises(InvalidSetting, match=r"shorten is -0\.01; .* from 0 to 100 m, in m"):
        LinkShortening("forearm_link", -0.01)
    with pytest.raises(InvalidSetting, match=r"gap is 3\.2; expected: an angle from 0 to 180 deg"):
        Backlash("elbow_joint", 3.2)
