"""The chain against Pinocchio, which is the reference."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from recalib.damaged.damage import BaseShift, LinkShortening, apply
from recalib.damaged.plant import Plant
from recalib.errors import UnsuitableRobot
from recalib.nominal.chain import Chain
from recalib.nominal.kinematics import Arm
from recalib.study.plants import nominal_robot

POSTURES = arrays(float, (3, 6), elements=st.floats(-np.pi, np.pi))


def some_damage(robot):
    shift = BaseShift(translation=(0.01, -0.02, 0.03), rotation=(0.1, -0.2, 0.3))
    return [shift, *(LinkShortening(link, 0.01) for link in [*robot.links][2:4])]


@pytest.fixture(scope="module")
def arms(plan) -> list[tuple[Arm, Chain]]:
    """Nominal and damaged arms of all robots, and one with axes along no coordinate."""
    robots = [nominal_robot(plan.nominal(name)) for name in plan.study.robots]
    arms = [robot.arm for robot in robots]
    arms += [apply(robot, some_damage(robot)).arm for robot in robots]
    askew = pin.Model()
    for joint in range(6):
        turn = pin.JointModelRevoluteUnaligned(*pin.exp3(np.full(3, joint)) @ [0.6, 0.0, 0.8])
        askew.addJoint(joint, turn, pin.SE3(pin.exp3(np.ones(3)), np.full(3, 0.2)), str(joint))
    askew.addFrame(pin.Frame("tool", 6, pin.SE3.Identity(), pin.FrameType.BODY))
    return [(arm, Chain.of(arm)) for arm in (*arms, Arm(askew, "tool"))]


@settings(max_examples=25)
@given(angles=POSTURES)
def test_the_chain_moves_as_pinocchio_says(arms, angles):
    for arm, chain in arms:
        poses, jacobians = arm.forward_and_jacobian(angles)
        np.testing.assert_allclose(chain.forward(angles[None])[0], poses, rtol=0, atol=1e-12)
        np.testing.assert_allclose(chain.jacobians(angles), jacobians, rtol=0, atol=1e-12)


def test_a_posture_does_not_depend_on_those_beside_it(arms):
    angles = np.random.default_rng(0).uniform(-np.pi, np.pi, (41, 6))
    for _, chain in arms:
        poses = chain.forward(angles[None])[0]
        solved = chain.solve(poses, angles + 0.1)
        for index in range(len(angles)):
            assert np.array_equal(chain.forward(angles[None, [index]])[0, 0], poses[index])
            alone = chain.solve(poses[[index]], angles[[index]] + 0.1)
            for whole, part in zip(solved, alone, strict=True):
                assert np.array_equal(whole[[index]], part)


def test_arms_side_by_side_move_as_they_do_alone(controller, robot):
    damaged = [apply(robot, some_damage(robot)[:count]) for count in range(3)]
    commands = np.random.default_rng(1).uniform(-1, 1, (3, 5, 6))
    together, _ = Plant(controller, damaged).achieve(commands)
    alone = [
        Plant(controller, [arm]).achieve(own[None])[0][0]
        for arm, own in zip(damaged, commands, strict=True)
    ]
    assert np.array_equal(together, alone)


def test_a_joint_that_slides_is_refused():
    model = pin.Model()
    for joint in range(6):
        kind = pin.JointModelPZ() if joint == 4 else pin.JointModelRZ()
        model.addJoint(joint, kind, pin.SE3.Identity(), str(joint))
    model.addFrame(pin.Frame("tool", 6, pin.SE3.Identity(), pin.FrameType.BODY))
    with pytest.raises(UnsuitableRobot, match="slides"):
        Chain.of(Arm(model, "tool"))
