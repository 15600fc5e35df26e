import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening, apply
from recalib.damaged.nongeometric import EccentricGear
from recalib.identification.error_model import (
    JOINT_ERRORS,
    JOINT_WAVES,
    OFFSETS,
    ErrorModel,
)
from recalib.study.plants import nominal_robot

TWISTS = 42  # parameters of an arm of six joints and one target


def drawn(model: ErrorModel, seed: int) -> np.ndarray:
    return model.deviations * np.random.default_rng(seed).standard_normal(len(model.deviations))


@pytest.mark.parametrize("name", ["ur10", "ur5", "ur3", "z1"])
@pytest.mark.parametrize("at_nominal", [True, False])
def test_jacobians_agree_with_finite_differences(name, at_nominal, plan):
    robot = nominal_robot(plan.nominal(name))
    model = ErrorModel(robot.arm, JOINT_ERRORS)
    parameters = drawn(model, 1) * (not at_nominal)
    angles = robot.home + np.random.default_rng(2).uniform(-0.5, 0.5, (3, 6))
    poses, jacobians = model.linearise(parameters, angles, model.terms(angles))
    assert np.allclose(poses, model.predict(parameters, angles), atol=1e-12)
    for index, unit in enumerate(np.eye(len(parameters))):
        # central differences of the fourth order; torques make the column of the compliance large
        step = 1e-3 / max(1, np.abs(jacobians[..., index]).max())
        near, far = (
            (
                _turn(
                    model.predict(parameters - d * unit, angles),
                    model.predict(parameters + d * unit, angles),
                )
            )
            for d in (step, 2 * step)
        )
        assert np.allclose(jacobians[..., index], (8 * near - far) / (12 * step), atol=1e-6)


def _turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    turns = Rotation.from_matrix(end[:, :3, :3] @ start[:, :3, :3].swapaxes(1, 2)).as_rotvec()
    return np.concatenate([(end - start)[:, :3, 3], turns], axis=1)


def test_zero_parameters_are_the_nominal_arm(robot):
    angles = np.random.default_rng(3).uniform(-1, 1, (5, 6))
    model = ErrorModel(robot.arm, JOINT_WAVES)
    assert np.allclose(
        model.predict(np.zeros_like(model.deviations), angles), robot.arm.forward(angles)
    )


def test_offsets_are_encoder_shifts(robot):
    angles = np.random.default_rng(4).uniform(-1, 1, (5, 6))
    model = ErrorModel(robot.arm, OFFSETS)
    parameters = np.zeros_like(model.deviations)
    parameters[TWISTS + 2] = 0.07
    damaged = apply(robot, [EncoderShift("elbow_joint", 0.07)])
    assert np.allclose(model.predict(parameters, angles), damaged.forward(angles))
    assert model.coefficients(parameters)["offset"][2] == 0.07


def test_the_first_twist_moves_the_whole_arm(robot):
    angles = np.random.default_rng(5).uniform(-1, 1, (5, 6))
    model = ErrorModel(robot.arm, OFFSETS)
    parameters = np.zeros_like(model.deviations)
    parameters[:3] = 0.01, -0.02, 0.03
    damaged = apply(robot, [BaseShift(translation=(0.01, -0.02, 0.03))])
    assert np.allclose(model.predict(parameters, angles), damaged.forward(angles))


def test_sine_and_cosine_are_an_eccentric_gear(robot):
    angles = np.random.default_rng(6).uniform(-1, 1, (5, 6))
    model = ErrorModel(robot.arm, JOINT_ERRORS)
    names = list(model.coefficients(np.zeros_like(model.deviations)))
    parameters = np.zeros_like(model.deviations)
    for name, value in (("sine 1", np.cos(0.4)), ("cosine 1", np.sin(0.4))):
        parameters[TWISTS + 6 * names.index(name) + 3] = 0.01 * value
    damaged = apply(robot, [EccentricGear("wrist_1_joint", 0.01, 0.4)])
    assert np.allclose(model.predict(parameters, angles), damaged.forward(angles))


def test_the_nominal_arm_stays_as_it_is(robot):
    angles = np.random.default_rng(7).uniform(-1, 1, (5, 6))
    before = robot.arm.forward(angles)
    model = ErrorModel(robot.arm, OFFSETS)
    assert not np.allclose(
        model.predict(drawn(model, 8), angles),
        apply(robot, [LinkShortening("forearm_link", 0.01)]).forward(angles),
    )
    assert np.array_equal(robot.arm.forward(angles), before)
