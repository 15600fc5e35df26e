"""The most probable arm is that of a slow implementation, and doubts are where they belong."""

import numpy as np
import pytest

from recalib.damaged.disturbances import Disturbances, Noise
from recalib.identification.error_model import JOINT_ERRORS, OFFSETS, ErrorModel
from recalib.identification.estimation import _log_likelihood, identify
from recalib.identification.linearisation import displacements
from recalib.identification.observations import Observations
from recalib.nominal.poses import orientation_error, position_error
from tests import reference

NOISY = Disturbances(Noise(2e-4, np.radians(0.02)))


def postures(controller, count, seed=1) -> np.ndarray:
    workspace = controller.robot.workspace
    sample = workspace.sample(np.random.default_rng(seed), count)
    return controller.inverse(workspace.to_poses(sample))


def noisy(arm, angles, seed) -> np.ndarray:
    return NOISY.measure([np.random.default_rng(seed)], arm.forward(angles)[None])[0]


@pytest.mark.parametrize("terms", [OFFSETS, JOINT_ERRORS], ids=["offsets", "joint errors"])
@pytest.mark.parametrize("what", ["poses", "positions", "no outlier"])
def test_the_estimate_is_that_of_the_slow_implementation(robot, controller, damaged, terms, what):
    model, angles = ErrorModel(robot.arm, terms), postures(controller, 14)
    measured = noisy(damaged, angles, 2)
    if what != "no outlier":
        measured[3, :3, 3] += 0.03, -0.04, 0.0
    if what == "positions":
        measured = measured[:, :3, 3]
    by_posture = model.terms(angles)
    parameters, noise, weights, evidence = reference.identify(
        lambda these: model.linearise(these, angles, by_posture), model.deviations, measured
    )
    found = identify(model, Observations(angles, measured))
    unknown = np.sqrt(np.diag(found.covariance))
    assert np.abs((found.parameters - parameters) / unknown).max() < 0.01
    assert found.noise == pytest.approx(noise, rel=1e-3)
    assert found.weights == pytest.approx(weights, abs=1e-3)
    assert found.log_evidence == pytest.approx(evidence, abs=0.02)


def test_beyond_the_limit_a_loss_grows_like_the_logarithm():
    squares, limit, noise = np.array([4.0, 9, 12, 20, 100]), 9.0, np.array([0.1])
    residuals = np.zeros((1, len(squares), 3))
    residuals[0, :, 1] = noise * np.sqrt(squares)
    losses = np.where(squares <= limit, squares, limit * (1 + np.log(squares / limit))) / 2
    expected = -losses.sum() - 3 * len(squares) * np.log(noise).sum()
    assert _log_likelihood(residuals, noise, limit) == pytest.approx(expected)


@pytest.mark.parametrize("what", ["poses", "positions"])
def test_one_good_measurement_in_a_hundred_is_doubted(robot, controller, damaged, what):
    angles = postures(controller, 600)
    measured = noisy(damaged, angles, 3)
    if what == "positions":
        measured = measured[:, :3, 3]
    found = identify(ErrorModel(robot.arm, OFFSETS), Observations(angles, measured))
    assert 2 <= np.sum(found.weights < 1) <= 11  # of 6: within two standard deviations
    assert found.weights.min() > 0.3


def test_the_estimate_does_not_depend_on_the_order_of_the_measurements(robot, controller, damaged):
    model, angles = ErrorModel(robot.arm, OFFSETS), postures(controller, 12)
    measured, order = noisy(damaged, angles, 4), np.random.default_rng(5).permutation(12)
    one, other = (
        identify(model, Observations(angles[rows], measured[rows])) for rows in (slice(None), order)
    )
    assert other.parameters == pytest.approx(one.parameters, abs=1e-9)
    assert other.weights == pytest.approx(one.weights[order], abs=1e-6)


@pytest.mark.parametrize(("what", "rows"), [("poses", 8), ("positions", 30)])
def test_exact_measurements_identify_the_arm(robot, controller, damaged, what, rows):
    model, angles = ErrorModel(robot.arm, OFFSETS), postures(controller, 60)
    true = damaged.forward(angles)
    measured = true[:rows] if what == "poses" else true[:rows, :3, 3]
    found = identify(model, Observations(angles[:rows], measured))
    predicted = model.predict(found.parameters, angles)
    assert position_error(predicted, true).max() < 1e-6
    assert what == "positions" or orientation_error(predicted, true).max() < 1e-7


def test_the_start_changes_the_time_and_not_the_answer(robot, controller, damaged):
    model, angles = ErrorModel(robot.arm, OFFSETS), postures(controller, 60)
    seen = Observations(angles, noisy(damaged, angles, 4))
    cold = identify(model, seen)
    for start in (identify(model, seen[:30]), identify(ErrorModel(robot.arm, JOINT_ERRORS), seen)):
        warm = identify(model, seen, start)
        apart = model.predict(warm.parameters, angles) - model.predict(cold.parameters, angles)
        assert np.abs(apart).max() < 2e-5


def test_the_covariance_tells_how_wrong_predictions_are(robot, controller):
    """100 arms with noisy data: predicted poses err as their covariance says, within 20 %."""
    model, generator = ErrorModel(robot.arm, OFFSETS), np.random.default_rng(6)
    angles = postures(controller, 25)
    known, asked = angles[:20], angles[20:]
    squares, said = [], []
    for _ in range(100):
        parameters = model.deviations * generator.standard_normal(len(model.deviations))
        measured = NOISY.measure([generator], model.predict(parameters, known)[None])[0]
        estimate = identify(model, Observations(known, measured))
        predicted, jacobians = model.linearise(estimate.parameters, asked, model.terms(asked))
        squares.append(displacements(predicted, model.predict(parameters, asked)) ** 2)
        said.append(np.einsum("ndp,pq,ndq->nd", jacobians, estimate.covariance, jacobians))
    ratio = np.sqrt(np.mean(squares, axis=(0, 1)) / np.mean(said, axis=(0, 1)))
    assert np.all((ratio > 0.8) & (ratio < 1.2)), "of a coordinate"
