"""The most probable arm is that of a slow implementation, and doubts are where they belong."""

from dataclasses import replace

import numpy as np
import pytest

import recalib
from recalib.identification import identify, most_informative
from recalib.identification.model import ErrorModel, displacements
from tests import reference

NOISY = recalib.Disturbances(recalib.Noise(2e-4, np.radians(0.02)))


def postures(controller, count, seed=1) -> np.ndarray:
    workspace = controller.robot.workspace
    sample = workspace.sample(np.random.default_rng(seed), count)
    return controller.inverse(workspace.to_poses(sample))


def noisy(arm, angles, seed, disturbances=NOISY) -> np.ndarray:
    return disturbances.measure([np.random.default_rng(seed)], arm.forward(angles)[None])[0]


@pytest.mark.parametrize(
    "terms", [recalib.OFFSETS, recalib.JOINT_ERRORS], ids=["offsets", "joint errors"]
)
@pytest.mark.parametrize("what", ["poses", "positions", "no outlier"])
def test_the_estimate_is_that_of_the_slow_implementation(robot, damaged, terms, what):
    model = ErrorModel(robot.arm, terms)
    angles = np.random.default_rng(1).uniform(-2, 2, (20, 6))  # they show all that can be seen
    measured = noisy(damaged, angles, 2)
    if what != "no outlier":
        measured[3, :3, 3] += 0.03, -0.04, 0.0
    if what == "positions":
        measured = measured[:, :3, 3]
    by_posture = model.terms(angles)
    parameters, noise, weights, evidence = reference.identify(
        lambda these: model.linearise(these, angles, terms=by_posture), model.deviations, measured
    )
    found = identify(model, recalib.Observations(angles, measured))
    unknown = np.sqrt(np.diag(found.covariance))
    assert np.abs((found.parameters - parameters) / unknown).max() < 0.01
    assert found.noise == pytest.approx(noise, rel=1e-3)
    assert found.weights == pytest.approx(weights, abs=1e-3)
    assert found.log_evidence == pytest.approx(evidence, abs=0.02)


@pytest.mark.parametrize(("what", "rows"), [("poses", 8), ("positions", 30)])
def test_exact_measurements_identify_the_arm(robot, controller, damaged, what, rows):
    model, angles = ErrorModel(robot.arm, recalib.OFFSETS), postures(controller, 60)
    true = damaged.forward(angles)
    measured = true[:rows] if what == "poses" else true[:rows, :3, 3]
    found = identify(model, recalib.Observations(angles[:rows], measured))
    predicted = model.predict(found.parameters, angles)
    assert recalib.position_error(predicted, true).max() < 1e-6
    assert what == "positions" or recalib.orientation_error(predicted, true).max() < 1e-7


def test_the_start_changes_the_time_and_not_the_answer(robot, controller, damaged):
    model, angles = ErrorModel(robot.arm, recalib.OFFSETS), postures(controller, 60)
    observations = recalib.Observations(angles, noisy(damaged, angles, 4))
    cold = identify(model, observations)
    for start in (
        identify(model, observations[:30]),
        identify(ErrorModel(robot.arm, recalib.JOINT_ERRORS), observations),
    ):
        warm = identify(model, observations, start)
        gaps = model.predict(warm.parameters, angles) - model.predict(cold.parameters, angles)
        assert np.abs(gaps).max() < 2e-5


def test_the_covariance_tells_how_wrong_predictions_are(robot, controller):
    """100 arms with noisy data: predicted poses err as their covariance says, within 20 %."""
    model, generator = ErrorModel(robot.arm, recalib.OFFSETS), np.random.default_rng(6)
    angles = postures(controller, 25)
    known, asked = angles[:20], angles[20:]
    squares, variances = [], []
    for _ in range(100):
        parameters = model.deviations * generator.standard_normal(len(model.deviations))
        measured = NOISY.measure([generator], model.predict(parameters, known)[None])[0]
        estimate = identify(model, recalib.Observations(known, measured))
        predicted, jacobians = model.linearise(estimate.parameters, asked)
        squares.append(displacements(predicted, model.predict(parameters, asked)) ** 2)
        variances.append(np.einsum("ndp,pq,ndq->nd", jacobians, estimate.covariance, jacobians))
    ratio = np.sqrt(np.mean(squares, axis=(0, 1)) / np.mean(variances, axis=(0, 1)))
    assert np.all((ratio > 0.8) & (ratio < 1.2)), "of a coordinate"


@pytest.fixture
def angles(controller):
    return postures(controller, 9)


@pytest.fixture(params=["poses", "positions"])
def calibration(request, robot, damaged, angles):
    model, measured = ErrorModel(robot.arm, recalib.OFFSETS), damaged.forward(angles[:3])
    measured = measured if request.param == "poses" else measured[:, :3, 3]
    return recalib.Calibration(model, identify(model, recalib.Observations(angles[:3], measured)))


def test_each_of_a_set_is_the_best_given_those_before_it(calibration, angles):
    remaining, known = {*range(len(angles))}, calibration
    for number, covariance in most_informative(calibration, angles, 20):
        gains = recalib.information_gains(known, angles)
        assert number == max(remaining, key=gains.__getitem__)
        remaining.remove(number)
        before = np.linalg.slogdet(known.estimate.covariance).logabsdet
        shrunk = (before - np.linalg.slogdet(covariance).logabsdet) / 2
        assert shrunk == pytest.approx(gains[number], rel=1e-6)
        known = replace(calibration, estimate=replace(known.estimate, covariance=covariance))
    assert not remaining
