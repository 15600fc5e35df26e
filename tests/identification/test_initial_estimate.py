"""Instruments and targets may be anywhere, and arms of any joints."""

from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import (
    JOINT_ERRORS,
    OFFSETS,
    BadMeasurement,
    Distance,
    Observations,
    Row,
    arm_of_table,
    initial_frames,
    load_arm,
)
from recalib.identification import (
    BLOCKWISE,
    GEOMETRIC,
    OPEN,
    NoInitialEstimate,
    identify,
    turns_by_poses,
    validate,
)
from recalib.identification.closed_forms import _smallest
from recalib.identification.initial_estimate import _is_open
from recalib.identification.model import HELD, NO_ERRORS, ErrorModel
from tests.arms import GANTRY, SCARA, urdf
from tests.identification.real import ARMS, BALL, SOCKETS, Real, aligned, geometry_of


@pytest.fixture(scope="module", params=ARMS)
def arm(request):
    return load_arm(*ARMS[request.param])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_instrument_and_target_may_be_anywhere_whatever_a_few_outliers_say(positions, seed, arm):
    real = Real(arm, seed)
    observations = real.observe(30 if positions else 20, positions)
    bad = 3 * (seed % 2)
    observations.measured[:bad] = observations.measured[bad : 2 * bad]
    assert real.error(geometry_of(arm, observations).predict) < 5e-4


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_an_arm_that_turns_its_tool_about_one_axis_is_placed(load, positions):
    """How high it stands and where the target sits are one: the target is at the tool link."""
    real = Real(nominal := load(SCARA), 7)
    geometry = geometry_of(nominal, observations := real.observe(30, positions))
    assert real.error(geometry.predict) < 5e-4
    target = initial_frames(nominal, observations).targets[0, :3, 3]
    assert np.abs(target - [*real.targets[0, :2, 3], 0.0]).max() < 0.03


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_of_an_arm_that_never_turns_its_tool_the_target_is_at_the_tool_link(load, positions):
    real = Real(nominal := load(GANTRY), 7)
    frames = initial_frames(nominal, real.observe(30, positions))
    assert np.abs(frames.targets[0, :3, 3]).max() < 0.03


def test_a_target_that_is_rare_among_many_rows_is_placed_too(panda):
    real = Real(panda, 6, targets=2)
    joints, targets = real.postures(600), np.repeat([0, 1], [597, 3])
    observations = Observations(joints, real.poses(joints, targets), targets)
    frames = initial_frames(panda, observations)
    assert len(frames.targets) == 2
    reached = frames.base @ panda.forward(joints[-3:]) @ frames.targets[1]
    assert np.linalg.norm((reached - observations.measured[-3:])[:, :3, 3], axis=1).max() < 0.05


@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
@pytest.mark.parametrize("known", ["base", "target"])
def test_a_frame_that_is_known_stays_as_it_is(known, positions, arm):
    """What is found of the other one is right, far beyond what an arm's own errors may be."""
    real = Real(arm, 8)
    observations = real.observe(30, positions)
    observations.measured[:3] = observations.measured[3:6]  # outliers
    frame = real.base if known == "base" else real.targets[0]
    frames = initial_frames(arm, observations, **{known: frame})
    if known == "base":
        assert np.array_equal(frames.base, frame) and not frames.base_unknown
        assert np.abs(frames.targets[0, :3, 3] - real.targets[0, :3, 3]).max() < 0.05
    else:
        assert np.array_equal(frames.targets[0], frame) and not frames.targets_unknown
        assert np.abs(frames.base - real.base).max() < 0.05
    model, joints = ErrorModel(arm, OFFSETS, frames), observations.joints
    parameters = identify(model, observations).parameters
    assert real.error(partial(model.predict, parameters)) < 5e-4
    found = model.found(parameters)
    assert np.array_equal(found.base, frame) or np.array_equal(found.targets[0], frame)
    standing = model.standing(parameters, joints)
    ends = found.base @ model.own_arm(parameters).forward(standing) @ found.targets[0]
    np.testing.assert_allclose(ends, model.predict(parameters, joints), atol=1e-12)


def test_orientations_tell_the_turn_of_the_instrument_unless_the_tool_turns_about_one_axis():
    random = np.random.default_rng(9)
    turns = Rotation.random(12, random_state=9)
    tool, base, target = np.tile(np.eye(4), (12, 1, 1)), np.eye(4), np.eye(4)
    base[:3, :3], target[:3, :3] = turns[0].as_matrix(), turns[1].as_matrix()
    tool[:, :3, 3] = random.uniform(-1, 1, (12, 3))

    def base_turns(tool_turns: Rotation) -> list[np.ndarray]:
        tool[:, :3, :3] = tool_turns.as_matrix()
        return turns_by_poses(tool, Observations(np.zeros((12, 6)), base @ tool @ target))

    np.testing.assert_allclose(base_turns(turns), [base[:3, :3]], atol=1e-12)
    assert base_turns(Rotation.from_rotvec(random.uniform(-3, 3, (12, 1)) * [0, 0, 1])) == []


def test_positions_in_a_plane_tell_how_the_instrument_stands():
    """Those of a UR10 whose parallel axes alone move: the plane's two sides differ for the arm."""
    arm = load_arm(*ARMS["UR10"])
    real = Real(arm, 9)
    joints = real.postures(40)
    joints[:, [0, 4, 5]] = joints[0, [0, 4, 5]]
    exact = arm.forward(joints)
    observations = Observations(joints, (real.base @ exact @ real.targets[0])[:, :3, 3])
    frames = initial_frames(arm, observations)
    found = (frames.base @ exact @ frames.targets[0])[:, :3, 3]
    assert np.abs(found - observations.positions).max() < 1e-3


def test_positions_on_a_line_and_rotations_that_hardly_differ_tell_nothing():
    line = np.array([3, 0, -1]) + np.outer(np.linspace(0, 1, 20), [1, 2, 2])
    bent = line + np.outer(np.linspace(-1, 1, 20) ** 2, [0, 0.1, -0.1])
    for positions, is_open in ((line, True), (bent, False)):
        observations = Observations(np.zeros((20, 6)), positions)
        assert _is_open(np.tile(np.eye(4), (20, 1, 1)), observations, None) == is_open
    for count in (5, 500):
        alike = np.random.default_rng(count).normal(size=(count, 3, 3))
        alike *= np.sqrt(2 * count) / np.linalg.svd(alike.reshape(-1, 3), compute_uv=False)[0]
        found = [_smallest(part * OPEN * alike, alike[..., 0]) for part in (0.9, 2)]
        assert not found[0].any() and found[1].any()


def test_a_socket_beyond_the_known_ones_is_refused(panda):
    observations = Observations(np.zeros((3, 7)), sockets=np.zeros(3, dtype=int))
    with pytest.raises(BadMeasurement, match="socket of measurement 0"):
        identify(ErrorModel(panda, OFFSETS), observations)
    two = Observations(np.zeros((3, 7)), sockets=np.array([0, 0, 1]))
    with pytest.raises(NoInitialEstimate, match="3 rows; expected: at least 4"):
        initial_frames(panda, two)


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
    after, before = (real.error(partial(model.predict, fit.parameters)) for fit in (found, nominal))
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


def test_a_ball_in_two_sockets_identifies_an_arm_without_any_instrument(panda):
    """To the scale of the distance that is known."""
    real, sockets = Real(panda, 1), np.repeat([0, 1], 40)
    joints = np.concatenate([real.touching(BALL, socket, 40) for socket in SOCKETS])
    fresh = real.postures(100)
    tool, true = panda.forward(fresh), real.ball(BALL, fresh)
    before = aligned(tool[:, :3, 3] + tool[:, :3, :3] @ BALL, true)  # m
    after = []
    for length in (0.303, 0.3):
        distances = [Distance(0, 1, length)]
        found = geometry_of(panda, Observations(joints, sockets=sockets, distances=distances))
        after.append(aligned(found.predict(fresh)[:, :3, 3], true))
    assert after[0] > 1e-3 and before > 20 * after[1]
    one, other = found.frames.sockets
    assert np.linalg.norm(one - other) == pytest.approx(0.3, abs=2e-4)
    assert found.estimate.noise == pytest.approx([1e-4], rel=0.3)
