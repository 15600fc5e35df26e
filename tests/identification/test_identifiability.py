import numpy as np
import pytest

from recalib import Distance, Observations
from recalib.identification.checks.identifiability import Unidentifiable, unidentifiable_parameters
from tests.arms import INDUSTRIAL, RAILED
from tests.identification.real import Real, geometry_of

BASE, OFFSET, TARGET = range(6), 48, 42  # numbers of the Panda's parameters


def found(arm, hold=None, positions=False):
    real = Real(arm, 1)
    joints = real.postures(40)
    if hold is not None:
        joints[:, hold] = joints[0, hold]
    poses = real.poses(joints)
    observations = Observations(joints, poses[:, :3, 3] if positions else poses)
    return unidentifiable_parameters(geometry_of(arm, observations), observations)


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_an_arm_of_turning_joints_has_four_parameters_a_joint_and_six_at_its_ends(panda, positions):
    open_ones = found(panda, positions=positions)
    # without orientations three are held, of how the target is turned, and three are not told
    assert len(open_ones) == 8 * 6 + 7 - (4 * 7 + 6)
    assert all(one.lasting for one in open_ones)


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
@pytest.mark.parametrize("text", [INDUSTRIAL, RAILED], ids=["industrial", "on a rail"])
def test_what_goes_along_an_axis_no_posture_tells_however_links_are_bent(load, text, positions):
    open_ones = found(load(text), positions=positions)
    assert all(one.lasting for one in open_ones)
    slides = text.count("prismatic")  # of which an axis has a direction and no place
    turns = text.count("revolute")
    assert len(open_ones) == (turns + slides) * 7 + 6 - (4 * turns + 2 * slides + 6)


def test_the_offset_of_the_last_joint_is_a_turn_of_the_target(panda):
    (last,) = [one for one in found(panda) if one.parameter == OFFSET + 6]
    assert last == Unidentifiable(OFFSET + 6, (TARGET + 5,), True)


def test_the_offset_of_the_first_joint_is_a_move_of_the_instrument(panda):
    (first,) = [one for one in found(panda) if one.parameter == OFFSET]
    assert set(first.partners) <= {*BASE}


def test_a_joint_that_never_moved_leaves_open_what_moving_it_would_tell(panda):
    by_data = [one for one in found(panda, hold=3) if not one.lasting]
    assert len(by_data) >= 2
    assert not [one for one in found(panda) if not one.lasting]


def test_what_a_ball_in_sockets_leaves_open_no_other_postures_in_them_tell(panda):
    """The ball is always at the socket, such as when all of the arm is a little higher."""
    real, ball = Real(panda, 1), np.array([0.02, -0.01, 0.12])
    sockets = np.array([[0.45, -0.15, 0.1], [0.45, 0.15, 0.1]])
    joints = np.concatenate([real.touching(ball, socket, 80) for socket in sockets])
    observations = Observations(
        joints, sockets=np.repeat([0, 1], 80), distances=[Distance(0, 1, 0.3)]
    )
    open_ones = unidentifiable_parameters(geometry_of(panda, observations), observations)
    assert open_ones and all(one.lasting for one in open_ones)
