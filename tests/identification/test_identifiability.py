"""What rows leave open is known, and stays as given, whatever small misfit would like it to be."""

import numpy as np
import pytest

from recalib import OFFSETS, Calibration, Distance, Observations, initial_frames
from recalib.identification import Unseen, identify
from recalib.identification.checks.identifiability import Unidentifiable, unidentifiable_parameters
from recalib.identification.model import ErrorModel
from tests.arms import INDUSTRIAL, RAILED, urdf
from tests.identification.real import BALL, SOCKETS, Real, geometry_of

BASE, OFFSET, TARGET = range(6), 48, 42  # numbers of the Panda's parameters


def unidentifiable_of(arm, hold=None, positions=False):
    real = Real(arm, 1)
    joints = real.postures(40)
    if hold is not None:
        joints[:, hold] = joints[0, hold]
    poses = real.poses(joints)
    observations = Observations(joints, poses[:, :3, 3] if positions else poses)
    return unidentifiable_parameters(geometry_of(arm, observations), observations)


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_an_arm_of_turning_joints_has_four_parameters_a_joint_and_six_at_its_ends(panda, positions):
    open_ones = unidentifiable_of(panda, positions=positions)
    # without orientations, three of the target's rotation are held and three are unidentifiable
    assert len(open_ones) == 8 * 6 + 7 - (4 * 7 + 6)
    assert all(one.lasting for one in open_ones)


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
@pytest.mark.parametrize("text", [INDUSTRIAL, RAILED], ids=["industrial", "on a rail"])
def test_what_goes_along_an_axis_no_posture_tells_however_links_are_bent(load, text, positions):
    open_ones = unidentifiable_of(load(text), positions=positions)
    assert all(one.lasting for one in open_ones)
    slides = text.count("prismatic")  # of which an axis has a direction and no place
    turns = text.count("revolute")
    assert len(open_ones) == (turns + slides) * 7 + 6 - (4 * turns + 2 * slides + 6)


def test_offsets_of_the_first_and_last_joint_are_moves_of_what_stands_beside_them(panda):
    open_ones = unidentifiable_of(panda)
    (last,) = [one for one in open_ones if one.parameter == OFFSET + 6]
    assert last == Unidentifiable(OFFSET + 6, (TARGET + 5,), True)
    (first,) = [one for one in open_ones if one.parameter == OFFSET]
    assert set(first.partners) <= {*BASE}
    by_data = [one for one in unidentifiable_of(panda, hold=3) if not one.lasting]
    assert len(by_data) >= 2
    assert not [one for one in open_ones if not one.lasting], "unless a joint never moved"


def test_what_a_ball_in_sockets_leaves_open_no_other_postures_in_them_tell(panda):
    """The ball is always at the socket, such as when all of the arm is a little higher."""
    real = Real(panda, 1)
    joints = np.concatenate([real.touching(BALL, socket, 80) for socket in SOCKETS])
    sockets = np.repeat([0, 1], 80)
    observations = Observations(joints, sockets=sockets, distances=[Distance(0, 1, 0.3)])
    open_ones = unidentifiable_parameters(geometry_of(panda, observations), observations)
    assert open_ones and all(one.lasting for one in open_ones)


ROWS, DROOP = 60, 2e-3  # rad, by which the links hang: no model here holds it
DRILLING = urdf(
    ("turn", "revolute", "0 0 1", "0 0 0.4"),
    ("lift", "revolute", "0 1 0", "0.15 0 0"),
    ("reach", "revolute", "0 1 0", "0 0 0.6"),
    ("roll", "revolute", "1 0 0", "0.64 0 0.1"),
    ("pitch", "revolute", "0 1 0", "0 0 0"),
    ("spin", "revolute", "1 0 0", "0.1 0 0"),
    ("flange", "fixed", "0 0 1", "0.1 0 0"),
    mass=3.0,
)


def drilling(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Joints (n, 6) of rows in which the tool is upright, and of others."""
    random = np.random.default_rng(seed)
    joints = random.uniform(-0.7, 0.7, (2 * ROWS, 6))
    joints[:, [0, 5]] *= 2
    joints[:, 4] += np.pi / 2
    rows, others = joints[:ROWS], joints[ROWS:]
    rows[:, 3] = 0.0
    rows[:, 4] = np.pi / 2 - rows[:, 1] - rows[:, 2]
    return rows, others


@pytest.mark.parametrize("positions", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_the_length_of_a_tool_that_is_always_upright_stays_as_given(load, positions, seed):
    arm = load(DRILLING)
    real = Real(arm, seed)
    rows, others = drilling(seed)

    def poses(joints, noise):
        droop = np.zeros_like(joints)
        droop[:, 1], droop[:, 2] = np.sin(joints[:, 1]), np.cos(joints[:, 1] + joints[:, 2])
        return real.poses(joints + DROOP * droop, noise=noise)

    measured = poses(rows, (1e-4, 1e-4))
    observations = Observations(rows, measured[:, :3, 3] if positions else measured)
    frames = initial_frames(arm, observations, target=real.targets[0])
    model = ErrorModel(arm, OFFSETS, frames)
    found = Calibration(model, identify(model, observations))
    wear = found.estimate.parameters / model.deviations
    assert np.abs(wear[~model.free]).max() < 1.5
    open_now = [one for one in unidentifiable_parameters(found, observations) if not one.lasting]
    assert open_now, "other postures would determine them"
    gaps = found.predict(others) - poses(others, (0, 0))
    assert np.linalg.norm(gaps[:, :3, 3], axis=1).mean() < 5e-3  # m


def test_rows_all_over_the_workspace_show_all_that_can_be_seen(ur10):
    observations = Real(ur10, 1).observe(30)
    model = ErrorModel(ur10, OFFSETS, initial_frames(ur10, observations))
    assert not Unseen(model, observations).directions.size
