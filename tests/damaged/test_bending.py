"""A collision bends and twists a link: where the rest of the arm then is."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import InvalidSetting, LinkBend, LinkTwist, UnknownName, apply
from recalib.nominal import link_end
from tests.arms import urdf

LINKS = ["upper_arm_link", "forearm_link", "wrist_3_link"]  # across two axes; along x; the tool


def ends(robot, damage) -> tuple[np.ndarray, np.ndarray]:
    """Where the link of a damage ends in its frame (4, 4): as built, and damaged."""
    arms = robot.arm, apply(robot, [damage]).arm
    built, damaged = (link_end(arm, robot.links[damage.link]).homogeneous for arm in arms)
    return built, damaged


def angle(one, other) -> float:
    """Between two directions [rad]."""
    return np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)


@pytest.mark.parametrize("link", LINKS)
def test_halves_of_a_bent_link_are_at_an_angle(robot, link):
    built, bent = ends(robot, LinkBend(link, 0.2))
    half = built[:3, 3] / 2
    outer = bent[:3, 3] - half
    assert np.linalg.norm(outer) == pytest.approx(np.linalg.norm(half)), "it is as long as before"
    assert angle(outer, half) == pytest.approx(0.2)
    turn = bent[:3, :3] @ built[:3, :3].T  # the next joint goes with the outer half
    np.testing.assert_allclose(turn @ half, outer, atol=1e-12)
    assert Rotation.from_matrix(turn).magnitude() == pytest.approx(0.2)


@pytest.mark.parametrize("link", LINKS)
def test_a_link_bends_towards_an_axis_of_its_frame_or_any_angle_from_there(robot, link):
    built, _ = ends(robot, LinkBend(link, 0.0))
    line = built[:3, 3] / np.linalg.norm(built[:3, 3])
    across = np.eye(3)[np.abs(line).round(6).argmin()]
    sideways = across - (across @ line) * line
    for towards in (0.0, 0.4, -2.0, np.pi):
        _, bent = ends(robot, LinkBend(link, 0.1, towards))
        moved = bent[:3, 3] - built[:3, 3]
        moved -= (moved @ line) * line
        expected = Rotation.from_rotvec(towards * line).apply(sideways)
        assert angle(moved, expected) == pytest.approx(0, abs=1e-6)
    opposite = [ends(robot, LinkBend(link, *bend))[1] for bend in ((0.1, np.pi), (-0.1, 0.0))]
    np.testing.assert_allclose(*opposite, atol=1e-12)


def test_rounding_does_not_decide_towards_which_axis_a_link_bends(load):
    joint, bent = ("turn", "revolute", "0 0 1", "0 0 0.3"), []
    for end in ("0.5 0 0", "0.5 1e-12 0"):
        arm = load(urdf(joint, ("lift", "revolute", "0 1 0", end)))
        bent.append(apply(arm, [LinkBend("link_1", 0.1)]).arm.forward(np.zeros((1, 2))))
    np.testing.assert_allclose(*bent, atol=1e-9)


@pytest.mark.parametrize("link", LINKS)
def test_a_twisted_link_turns_what_follows_about_its_line(robot, link):
    built, twisted = ends(robot, LinkTwist(link, -0.3))
    assert np.array_equal(twisted[:3, 3], built[:3, 3])
    turn = Rotation.from_matrix(twisted[:3, :3] @ built[:3, :3].T).as_rotvec()
    np.testing.assert_allclose(turn, -0.3 * built[:3, 3] / np.linalg.norm(built[:3, 3]), atol=1e-12)


def test_what_cannot_bend_is_refused(robot, redundant):
    with pytest.raises(UnknownName, match="did you mean forearm_link"):
        apply(robot, [LinkBend("forarm_link", 0.1)])
    for damage in (LinkBend("panda_link1", 0.1), LinkTwist("panda_link1", 0.1)):
        with pytest.raises(InvalidSetting, match="'panda_link1'; expected: a link with a length"):
            apply(redundant.robot, [damage])
