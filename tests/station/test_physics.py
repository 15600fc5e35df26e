"""The arm in MuJoCo is the arm of Pinocchio, and droops as statics says."""

import numpy as np
import pytest

from recalib import DamagedArm, EncoderShift, LinkShortening, apply, load_arm, load_robot

pytest.importorskip("mujoco", reason="of the extra live")
import simulated_arm as physics

Gears, PhysicsStation = physics.Gears, physics.PhysicsStation
pytestmark = pytest.mark.slow  # only slow tests and pages use this arm
ARMS = {"ur10": ("ur10_robot.urdf", "tool0"), "panda": ("panda.urdf", "panda_link8")}


def intact(name: str) -> DamagedArm:
    arm = load_arm(*ARMS[name])
    return DamagedArm(arm, np.zeros(arm.model.nv))


def bent() -> DamagedArm:
    home = dict.fromkeys(load_arm(*ARMS["ur10"]).joints, -1.0)
    robot = load_robot(*ARMS["ur10"], home, [0.1] * 3, [0.1] * 3)
    damages = LinkShortening("forearm_link", 0.04), EncoderShift("elbow_joint", 0.07)
    return apply(robot, damages)


def postures(damaged: DamagedArm, count: int) -> np.ndarray:
    """(count, joints) rad, within the limits."""
    model = damaged.arm.model
    low, high = model.lowerPositionLimit, model.upperPositionLimit
    low, high = np.maximum(low, -3), np.minimum(high, 3)
    return np.random.default_rng(0).uniform(low, high, (count, len(low)))


@pytest.mark.parametrize("damaged", [bent(), intact("panda")], ids=["bent ur10", "panda"])
def test_joints_droop_by_their_torque_over_their_stiffness(damaged):
    joints, stiffness = postures(damaged, 5), np.linspace(2e4, 5e3, damaged.arm.model.nv)
    droop = (
        (PhysicsStation(damaged, Gears(stiffness)).forward(joints)[:, :3, 3])
        - damaged.forward(joints)[:, :3, 3]
    )
    standing = damaged.standing(joints)
    for _ in range(5):  # the torque is that where it stands
        standing = damaged.standing(joints) - damaged.arm.gravity_torque(standing) / stiffness
    expected = damaged.arm.forward(standing)[:, :3, 3] - damaged.forward(joints)[:, :3, 3]
    assert np.linalg.norm(expected, axis=1).max() > 2e-3
    errors, droops = (np.linalg.norm(gaps, axis=1) for gaps in (droop - expected, expected))
    assert errors.max() < 0.01 * droops.min()
