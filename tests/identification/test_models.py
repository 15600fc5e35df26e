"""What a model may explain, when a richer one is taken, and what is kept of a calibration."""

import numpy as np
import pytest

from recalib.damaged.damage import apply
from recalib.damaged.disturbances import Disturbances, Noise
from recalib.damaged.nongeometric import EccentricGear, Sag
from recalib.identification.calibration import Calibration, calibrate
from recalib.identification.design import information_gains
from recalib.identification.error_model import JOINT_ERRORS, JOINT_WAVES, OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.observations import Observations
from recalib.nominal.poses import orientation_error, position_error
from tests.identification.test_estimation import noisy, postures

EXACT = Disturbances(Noise(1e-5, 1e-4))


def measured_by(disturbances, arm, angles, seed) -> np.ndarray:
    return disturbances.measure([np.random.default_rng(seed)], arm.forward(angles)[None])[0]


def test_joint_errors_are_believed_to_be_as_large_as_those_of_worn_arms(robot, controller):
    """By their largest over the workspace: of a gear out of centre half a degree, and so on."""
    angles = postures(controller, 50)
    model = ErrorModel(robot.arm, JOINT_WAVES)
    of_terms = model.deviations[-6 * len(model.names) :].reshape(-1, 6)
    largest = np.degrees(np.abs(model.terms(angles)).max(axis=0) * of_terms).max(axis=1)
    believed = dict(zip(model.names, largest, strict=True))
    assert believed["offset"] == pytest.approx(4)
    assert 0.3 < believed["compliance"] < 3  # degrees under the arm's own weight
    assert believed["sine 1"] == pytest.approx(0.5, rel=0.1)
    for order in (2, 12, 24):
        assert believed[f"sine {order}"] == pytest.approx(0.05 / order, rel=0.2)


def test_each_model_begins_with_the_one_before_it_and_ends_at_24_waves_a_turn(robot, controller):
    names = [ErrorModel(robot.arm, terms).names for terms in (OFFSETS, JOINT_ERRORS, JOINT_WAVES)]
    waves = [f"{wave} {order}" for order in range(1, 25) for wave in ("sine", "cosine")]
    assert [*names[2]] == ["offset", "compliance", *waves]
    assert names[0] == names[2][:1] and names[1] == names[2][:4]
    angles = postures(controller, 3)
    terms = ErrorModel(robot.arm, JOINT_WAVES).terms(angles)
    for order in (1, 2, 17, 24):
        assert np.allclose(terms[:, 2 * order], np.sin(order * angles))
        assert np.allclose(terms[:, 2 * order + 1], np.cos(order * angles))


def test_where_geometry_alone_is_wrong_geometry_alone_is_used(robot, controller, damaged):
    angles = postures(controller, 24)
    for seed in range(3):
        found = calibrate(
            robot.arm, (OFFSETS, JOINT_ERRORS), Observations(angles, noisy(damaged, angles, seed))
        )
        assert found.model.names == ("offset",) and found.pattern is None


def test_where_more_is_wrong_the_model_that_says_it_is_used(robot, controller):
    angles = postures(controller, 24)
    bent = apply(robot, [Sag(joint, 1e-4) for joint in robot.joints])
    found = calibrate(
        robot.arm, (OFFSETS, JOINT_ERRORS), Observations(angles, noisy(bent, angles, 1))
    )
    assert len(found.model.names) == len(JOINT_ERRORS)
    compliance = found.model.coefficients(found.estimate.parameters)["compliance"]
    assert compliance[1:3] == pytest.approx([-1e-4] * 2, rel=0.1)


@pytest.fixture(scope="module")
def geared(robot, controller):
    """An arm of eccentric gears, postures, and what was measured there, one of them grossly off."""
    arm = apply(robot, [EccentricGear(joint, 0.01, 0.5) for joint in robot.joints])
    angles = postures(controller, 60)
    measured = measured_by(EXACT, arm, angles, 7)
    measured[20, :3, 3] += 0.1, 0.0, -0.1
    return arm, angles, measured


def test_what_no_term_explains_is_left_to_a_process_in_position_and_orientation(robot, geared):
    arm, angles, measured = geared
    found = calibrate(robot.arm, (OFFSETS,), Observations(angles, measured))
    asked, true = angles + 0.02, arm.forward(angles + 0.02)
    alone = Calibration(found.model, found.estimate).forward(asked)
    for error in (position_error, orientation_error):
        assert error(found.forward(asked), true).mean() < 0.3 * error(alone, true).mean()
    moved = found.forward(angles)[20] - arm.forward(angles)[20]
    assert np.abs(moved[:3, 3]).max() < 2e-3, "no pattern is learned from a doubted measurement"


@pytest.mark.parametrize("terms", [OFFSETS, JOINT_ERRORS, JOINT_WAVES], ids=["1", "4", "50"])
def test_a_calibration_of_any_model_is_restored_as_it_was(robot, geared, terms):
    _, angles, measured = geared
    model = ErrorModel(robot.arm, terms)
    few = slice(30 if len(terms) < 10 else 8)  # hundreds of parameters take their time
    found = calibrate(robot.arm, (terms,), Observations(angles[few], measured[few]))
    again = Calibration.restore(robot.arm, found.state())
    assert again.model.names == model.names
    assert np.array_equal(again.forward(angles), found.forward(angles))


@pytest.mark.parametrize("what", ["poses", "positions"])
def test_the_information_of_a_measurement_is_what_it_takes_from_the_uncertainty(
    robot, controller, damaged, what
):
    """Half the logarithm of the ratio of determinants, with and without it."""
    angles, model = postures(controller, 12), ErrorModel(robot.arm, OFFSETS)
    measured = noisy(damaged, angles, 1)
    if what == "positions":
        measured = measured[:, :3, 3]
    estimate = identify(model, Observations(angles[:8], measured[:8]))
    gains = information_gains(Calibration(model, estimate), angles[8:])
    _, jacobians = model.linearise(estimate.parameters, angles[8:], model.terms(angles[8:]))
    known = np.linalg.inv(estimate.covariance / np.outer(model.deviations, model.deviations))
    for gain, jacobian in zip(gains, jacobians * model.deviations, strict=True):
        rows = jacobian[: 3 * len(estimate.noise)] / np.repeat(estimate.noise, 3)[:, None]
        taken = np.linalg.slogdet(known + rows.T @ rows)[1] - np.linalg.slogdet(known)[1]
        assert gain == pytest.approx(taken / 2, rel=1e-4)
