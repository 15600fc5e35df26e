"""Joints that do not turn as their columns say are named; gears, sag and chance are not."""

import numpy as np
import pytest

from recalib import Observations
from recalib.identification.checks.gains import wrong_gain
from tests.identification.honesty import AROUND, MIDDLE
from tests.identification.real import Real, geometry_of


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
