"""The chain against Pinocchio, which is the reference."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from recalib import Arm, BaseShift, Chain, LinkShortening, apply, load_arm
from replication.scenarios import nominal_robot

POSTURES = arrays(float, (3, 8), elements=st.floats(-np.pi, np.pi))  # of so many joints or fewer
OTHERS = {"panda.urdf": "panda_hand_tcp", "tiago.urdf": "hand_tool_link", "so100.urdf": "gripper"}


def some_damage(robot):
    shift = BaseShift(translate=(0.01, -0.02, 0.03), rotate=(0.1, -0.2, 0.3))
    return [shift, *(LinkShortening(link, 0.01) for link in [*robot.links][2:4])]


def askew(slides: Sequence[bool]) -> Arm:
    """An arm with axes along no coordinate."""
    model = pin.Model()
    for joint, slide in enumerate(slides):
        axis = pin.exp3(np.full(3, joint)) @ [0.6, 0.0, 0.8]
        kind = pin.JointModelPrismaticUnaligned if slide else pin.JointModelRevoluteUnaligned
        placement = pin.SE3(pin.exp3(np.ones(3)), np.full(3, 0.2))
        model.addJoint(joint, kind(*axis), placement, str(joint))
    model.addFrame(pin.Frame("tool", len(slides), pin.SE3.Identity(), pin.FrameType.BODY))
    return Arm(model, "tool", "world")


@pytest.fixture(scope="module")
def arms(plan) -> list[tuple[Arm, Chain]]:
    """Nominal and damaged arms of all robots, and others with two to eight joints."""
    robots = [nominal_robot(plan.nominal(name)) for name in plan.study.robots]
    arms = [robot.arm for robot in robots]
    arms += [apply(robot, some_damage(robot)).arm for robot in robots]
    arms += [load_arm(*other) for other in OTHERS.items()]
    arms += [askew(slides) for slides in ([False] * 6, [True, False], [False, True, False] * 2)]
    return [(arm, Chain.of(arm)) for arm in arms]


@settings(max_examples=10)
@given(postures=POSTURES)
def test_the_chain_moves_as_pinocchio_says(arms, postures):
    for arm, chain in arms:
        angles = postures[:, : len(arm.joints)]
        poses = arm.forward(angles)
        np.testing.assert_allclose(chain.forward(angles[None])[0], poses, rtol=0, atol=1e-12)


def test_a_posture_does_not_depend_on_those_beside_it(arms):
    postures = np.random.default_rng(0).uniform(-np.pi, np.pi, (41, 8))
    for arm, chain in arms:
        angles = postures[:, : len(arm.joints)]
        poses = chain.forward(angles[None])[0]
        solved = chain.solve(poses, angles + 0.1)
        for index in range(len(angles)):
            assert np.array_equal(chain.forward(angles[None, [index]])[0, 0], poses[index])
            alone = chain.solve(poses[[index]], angles[[index]] + 0.1)
            for whole, part in zip(solved, alone, strict=True):
                assert np.array_equal(whole[[index]], part)


def test_a_start_of_whole_numbers_does_not_round_what_is_found(arms):
    _, chain = arms[0]
    angles = np.array([[0.1, -1.2, 1.3, 0.4, 0.5, 0.6]])
    poses, start = chain.forward(angles[None])[0], np.array([[0, -1, 1, 0, 0, 1]])
    found, errors = chain.solve(poses, start)
    np.testing.assert_array_equal(found, chain.solve(poses, start.astype(float))[0])
    np.testing.assert_allclose(chain.forward(found[None])[0], poses, rtol=0, atol=1e-9)
    assert start.dtype == int
    assert errors.max() < 1e-9
    start = np.repeat(angles, 3, axis=0)
    poses = chain.forward(start[None])[0]
    poses[0, 0, 3] = start[1, 2] = np.nan  # all other numbers of the first residual are zero
    np.testing.assert_array_equal(chain.solve(poses, start)[1] < 1e-9, [False, False, True])
