"""Jacobians of the error model, and damages as its parameters."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import JOINT_ERRORS, JOINT_WAVES, BaseShift, EccentricGear, EncoderShift, apply
from recalib.identification.model import ErrorModel
from recalib.identification.model.optics import _whitening
from replication.scenarios import nominal_robot
from tests.arms import RAILED

TWISTS = 42  # parameters of an arm of six joints and one target


def drawn(model: ErrorModel, seed: int) -> np.ndarray:
    return model.deviations * np.random.default_rng(seed).standard_normal(len(model.deviations))


@pytest.mark.parametrize("name", ["ur10", "z1", "railed"])
@pytest.mark.parametrize("at_nominal", [True, False])
def test_jacobians_agree_with_finite_differences(name, at_nominal, plan, load):
    if name == "railed":
        arm, home, terms = load(RAILED), np.full(7, 0.4), JOINT_WAVES
    else:
        robot = nominal_robot(plan.nominal(name))
        arm, home, terms = robot.arm, robot.home, JOINT_ERRORS
    model = ErrorModel(arm, terms)
    parameters = drawn(model, 1) * (not at_nominal)
    angles = home + np.random.default_rng(2).uniform(-0.5, 0.5, (3, len(home)))
    poses, jacobians = model.linearise(parameters, angles)
    assert np.allclose(poses, model.predict(parameters, angles), atol=1e-12)
    for index, unit in enumerate(np.eye(len(parameters))):
        # central differences of the fourth order; torques make the column of the compliance large
        step = 1e-3 / max(1, np.abs(jacobians[..., index]).max())
        narrow, wide = (
            _turn(*(model.predict(parameters + sign * d * unit, angles) for sign in (-1, 1)))
            for d in (step, 2 * step)
        )
        assert np.allclose(jacobians[..., index], (8 * narrow - wide) / (12 * step), atol=1e-6)


def _turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    turns = Rotation.from_matrix(end[:, :3, :3] @ start[:, :3, :3].swapaxes(1, 2)).as_rotvec()
    return np.concatenate([(end - start)[:, :3, 3], turns], axis=1)


@pytest.mark.parametrize(
    ("parameters", "damage"),
    [
        ({"offset": 0.07}, EncoderShift("elbow_joint", 0.07)),
        (
            {"sine 1": 0.01 * np.cos(0.4), "cosine 1": 0.01 * np.sin(0.4)},
            EccentricGear("elbow_joint", 0.01, 0.4),
        ),
        ({"twist": (0.01, -0.02, 0.03)}, BaseShift(translate=(0.01, -0.02, 0.03))),
    ],
    ids=["offset", "gear", "base"],
)
def test_a_damage_has_parameters(parameters, damage, robot):
    """Of the elbow, the third joint, or of the first twist, which moves the whole arm."""
    angles = np.random.default_rng(4).uniform(-1, 1, (5, 6))
    model = ErrorModel(robot.arm, JOINT_ERRORS)
    names, found = list(model.names), np.zeros_like(model.deviations)
    for name, value in parameters.items():
        if name == "twist":
            found[:3] = value
        else:
            found[TWISTS + 6 * names.index(name) + 2] = value
            assert model.coefficients(found)[name][2] == value
    assert np.allclose(model.predict(found, angles), apply(robot, [damage]).forward(angles))


def test_a_picture_far_off_does_not_change_what_a_typical_one_weighs():
    spread = np.stack([np.diag([4.0, 4.0, 4.0, 9.0, 9.0, 9.0])] * 5)
    spread[-1] *= 1e4
    assert _whitening(spread)[:-1] == pytest.approx(np.stack([np.eye(6)] * 4))
    assert _whitening(spread)[-1] == pytest.approx(np.eye(6) / 100)
