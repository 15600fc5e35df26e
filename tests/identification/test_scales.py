"""Wrong scales and gains are named; other links, gears, sag and chance are not."""

from dataclasses import replace

import numpy as np
import pytest

from recalib import Observations, initial_frames
from recalib.identification.checks.gains import wrong_gain
from recalib.identification.checks.scales import scales
from tests.arms import urdf
from tests.identification.honesty import AROUND, MIDDLE
from tests.identification.real import Real, geometry_of

TOGETHER = 0.3  # of the noise, as where links grew by one factor


def scale_of(arm, observations: Observations):
    (found,) = scales(arm, observations, initial_frames(arm, observations))
    return found


@pytest.mark.parametrize("kind", ["positions", "poses"])
@pytest.mark.parametrize("factor", [1.03, 0.9])
def test_positions_of_another_scale_are_known_by_the_links(factor, kind, ur10):
    observations = Real(ur10, 1).observe(40, kind == "positions")
    right = scale_of(ur10, observations)
    assert right.factor == pytest.approx(1, abs=5e-3) and right.remaining > 0.9
    measured = observations.measured.copy()
    (measured if kind == "positions" else measured[:, :3, 3])[:] *= factor
    found = scale_of(ur10, replace(observations, measured=measured))
    assert found.factor == pytest.approx(1 / factor, abs=5e-3) and found.remaining < TOGETHER


def test_one_link_that_is_shorter_or_a_joint_without_length_is_no_scale(ur10, load):
    other = ur10.copy()
    placement = other.model.jointPlacements[3]
    placement.translation = placement.translation * 0.93  # by 4 cm
    joints = np.random.default_rng(1).uniform(-1, 1, (40, 6))
    found = scale_of(ur10, Observations(joints, other.forward(joints)[:, :3, 3]))
    assert found.remaining > TOGETHER
    arm, random = load(urdf(("turn", "revolute", "0 0 1", "0 0 0.3"))), np.random.default_rng(0)
    joints, target = random.uniform(-2, 2, (30, 1)), np.eye(4)
    target[:3, 3] = 0.3, 0.1, 0.1
    measured = (arm.forward(joints) @ target)[:, :3, 3] + random.normal(0, 1e-4, (30, 3))
    assert scale_of(arm, Observations(joints, measured)).remaining > TOGETHER


def turning(ur10, seed: int, joint: int, by: int, share: float, gears: float = 0.0):
    """What is found where a joint turns, in addition, by a share of another's column."""
    real, random = Real(ur10, seed, gears=gears), np.random.default_rng([seed, 4])
    joints = MIDDLE + random.uniform(-AROUND, AROUND, (60, 6))
    turned = joints.copy()
    turned[:, joint] += share * joints[:, by]
    poses = real.poses(turned)
    observations = Observations(joints, poses if seed % 2 else poses[:, :3, 3])
    return wrong_gain(geometry_of(ur10, observations), observations)


@pytest.mark.parametrize(
    ("joint", "by", "share"),
    [(2, 2, -0.05), (4, 3, 0.02), (2, 1, 0.03), (3, 3, 0.03), (1, 2, -0.015)],
)
@pytest.mark.parametrize("seed", [1, 2])
def test_a_coupled_joint_and_another_gain_are_named(ur10, seed, joint, by, share):
    found = turning(ur10, seed, joint, by, share)
    assert (found.joint, found.by) == (joint, by)
    assert found.share == pytest.approx(share, rel=0.15)


@pytest.mark.parametrize("gears", [0.0, 2e-3])
@pytest.mark.parametrize("seed", range(4))
def test_joints_that_turn_as_their_columns_say_are_left_alone(ur10, seed, gears):
    assert turning(ur10, seed, 0, 0, 0.0, gears) is None
