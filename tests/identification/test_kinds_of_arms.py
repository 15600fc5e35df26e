"""Arms of any joints are identified, by instruments or without one."""

from functools import partial

import numpy as np
import pytest

from recalib import JOINT_ERRORS, OFFSETS, Distance, Observations, Row, arm_of_table, initial_frames
from recalib.identification import BLOCKWISE, GEOMETRIC, identify, validate
from recalib.identification.model import HELD, NO_ERRORS, ErrorModel
from tests.arms import GANTRY, SCARA, urdf
from tests.identification.real import Real, aligned, geometry_of

BALL, SOCKETS = np.array([0.02, -0.01, 0.12]), np.array([[0.45, -0.15, 0.1], [0.45, 0.15, 0.1]])


@pytest.mark.parametrize("text", [SCARA, GANTRY], ids=["SCARA", "gantry"])
@pytest.mark.parametrize("what", ["poses", "positions"])
def test_joints_that_slide_are_identified(text, what, load):
    arm = load(text)
    real = Real(arm, 1)
    observations = real.observe(30, what == "positions")
    model = ErrorModel(arm, OFFSETS, initial_frames(arm, observations))
    found = identify(model, observations)
    assert found.converged
    nominal = identify(ErrorModel(arm, NO_ERRORS, model.frames), observations)
    after, before = (real.error(partial(model.predict, its.parameters)) for its in (found, nominal))
    assert after < 4e-4 and before > 3 * after


@pytest.mark.parametrize("slides", [False, True], ids=["turns", "slides"])
def test_an_arm_of_one_joint_is_calibrated(slides):
    arm = arm_of_table([Row("only", a=0.5, slides=slides)])
    rng = np.random.default_rng(0)
    joints = rng.uniform(-1, 1, (40, 1))
    measured = arm.forward(joints + 0.02)[:, :3, 3] + rng.normal(0, 1e-4, (40, 3))
    found = validate(arm, Observations(joints, measured))
    assert found.chosen == GEOMETRIC
    assert found.mean_error(BLOCKWISE, GEOMETRIC) < 3e-4


def test_what_a_joint_or_an_arm_cannot_have_is_held_at_zero(load):
    joints = [("turn", "revolute", "0 0 1", "0 0 1"), ("slide", "prismatic", "1 0 0", "0 0 0")]
    for mass, gravity in ((0.0, True), (1.0, False)):
        model = ErrorModel(load(urdf(*joints, mass=mass)), JOINT_ERRORS)
        held = model.coefficients(model.deviations <= HELD)
        assert held["offset"].tolist() == [False, False]
        assert held["compliance"].tolist() == [gravity, True]
        assert held["sine 1"].tolist() == held["cosine 1"].tolist() == [False, True]


@pytest.fixture(scope="module")
def balls(panda):
    """Of a Panda: what joint angles alone tell, and before and after [m] with frames aligned."""
    real = Real(panda, 1)
    joints = np.concatenate([real.touching(BALL, socket, 40) for socket in SOCKETS])
    fresh = real.postures(100)
    tool, true = panda.forward(fresh), real.ball(BALL, fresh)

    def after(observations):
        found = geometry_of(panda, observations)
        return aligned(found.predict(fresh)[:, :3, 3], true), found

    before = aligned(tool[:, :3, 3] + tool[:, :3, :3] @ BALL, true)
    return joints, np.repeat([0, 1], 40), before, after


def test_a_ball_in_two_sockets_identifies_an_arm_without_any_instrument(balls):
    joints, sockets, before, after = balls
    left, found = after(Observations(joints, None, None, sockets, [Distance(0, 1, 0.3)]))
    assert before > 20 * left
    one, other = found.frames.sockets
    assert np.linalg.norm(one - other) == pytest.approx(0.3, abs=2e-4)
    assert found.estimate.noise == pytest.approx([1e-4], rel=0.3)


def test_the_known_distance_sets_the_scale(balls):
    joints, sockets, _, after = balls
    left, _ = after(Observations(joints, None, None, sockets, [Distance(0, 1, 0.303)]))
    assert left > 1e-3
