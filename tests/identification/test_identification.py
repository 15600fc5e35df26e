import numpy as np
import pytest

from recalib.damaged.damage import apply
from recalib.damaged.disturbances import Disturbances, Noise
from recalib.damaged.nongeometric import Sag
from recalib.identification.error_model import JOINT_ERRORS, OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.linearisation import displacements
from recalib.identification.observations import Observations
from recalib.nominal.poses import orientation_error, position_error

NOISY = Disturbances(Noise(2e-4, np.radians(0.02)))


@pytest.fixture(scope="module")
def model(robot) -> ErrorModel:
    return ErrorModel(robot.arm, OFFSETS)


@pytest.fixture(scope="module")
def angles(controller) -> np.ndarray:
    workspace = controller.robot.workspace
    return controller.inverse(workspace.to_poses(workspace.sample(np.random.default_rng(1), 60)))


def worst(model, estimate, arm, angles) -> tuple[float, float]:
    predicted, true = model.predict(estimate.parameters, angles), arm.forward(angles)
    return position_error(predicted, true).max(), orientation_error(predicted, true).max()


def noisy(disturbances, arm, angles, seed) -> np.ndarray:
    return disturbances.measure([np.random.default_rng(seed)], arm.forward(angles)[None])[0]


def test_exact_poses_identify_the_arm(model, damaged, angles):
    estimate = identify(model, Observations(angles[:8], damaged.forward(angles[:8])))
    assert max(worst(model, estimate, damaged, angles[8:])) < 1e-7


def test_one_pose_is_better_than_none(model, damaged, angles):
    estimate = identify(model, Observations(angles[:1], damaged.forward(angles[:1])))
    before = position_error(
        damaged.forward(angles), model.predict(0 * estimate.parameters, angles)
    ).mean()
    after = position_error(
        damaged.forward(angles), model.predict(estimate.parameters, angles)
    ).mean()
    assert after < before / 2


def test_the_noise_is_estimated(model, damaged, angles):
    estimate = identify(model, Observations(angles, noisy(NOISY, damaged, angles, 2)))
    assert estimate.noise == pytest.approx([2e-4, np.radians(0.02)], rel=0.15)


def test_outliers_are_found_and_count_for_nothing(model, damaged, angles):
    measured = noisy(NOISY, damaged, angles, 3)
    clean = worst(model, identify(model, Observations(angles, measured)), damaged, angles)
    spoilt = measured.copy()
    bad = np.arange(0, 60, 10)
    spoilt[bad, :3, 3] += 0.05 * np.array([0.6, -0.8, 0.0])
    estimate = identify(model, Observations(angles, spoilt))
    assert np.all(estimate.weights[bad] < 0.01)
    assert np.mean(np.delete(estimate.weights, bad)) > 0.95
    assert np.all(np.array(worst(model, estimate, damaged, angles)) < 2 * np.array(clean))


def test_positions_alone_identify_where_the_tool_gets_to(model, damaged, angles):
    estimate = identify(model, Observations(angles[:30], damaged.forward(angles[:30])[:, :3, 3]))
    assert worst(model, estimate, damaged, angles[30:])[0] < 1e-6
    assert estimate.noise.shape == (1,)


def test_the_start_changes_the_time_and_not_the_answer(model, damaged, angles):
    measured = noisy(NOISY, damaged, angles, 4)
    cold = identify(model, Observations(angles, measured))
    richer = identify(
        ErrorModel(model.arm(np.zeros_like(model.deviations)), JOINT_ERRORS),
        Observations(angles, measured),
    )
    for start in (identify(model, Observations(angles[:30], measured[:30])), richer):
        warm = identify(model, Observations(angles, measured), start)
        apart = model.predict(warm.parameters, angles) - model.predict(cold.parameters, angles)
        assert np.abs(apart).max() < 2e-5


def test_the_evidence_tells_sag_from_a_stiff_arm(robot, model, damaged, angles):
    richer = ErrorModel(robot.arm, JOINT_ERRORS)
    for arm, sagging in (
        (damaged, False),
        (apply(robot, [Sag(joint, 1e-4) for joint in robot.joints]), True),
    ):
        measured = noisy(NOISY, arm, angles[:24], 5)
        gain = (
            identify(richer, Observations(angles[:24], measured)).log_evidence
            - identify(model, Observations(angles[:24], measured)).log_evidence
        )
        assert gain > 50 if sagging else gain < 5


def test_the_covariance_tells_how_wrong_predictions_are(model, controller):
    """200 arms with noisy data: predicted poses err as their covariance says, within 20 %."""
    workspace, generator = controller.robot.workspace, np.random.default_rng(6)
    angles = controller.inverse(workspace.to_poses(workspace.sample(generator, 25)))
    known, asked = angles[:20], angles[20:]
    squares, said = [], []
    for _ in range(200):
        parameters = model.deviations * generator.standard_normal(len(model.deviations))
        measured = NOISY.measure([generator], model.predict(parameters, known)[None])[0]
        estimate = identify(model, Observations(known, measured))
        predicted, jacobians = model.linearise(estimate.parameters, asked, model.terms(asked))
        squares.append(displacements(predicted, model.predict(parameters, asked)) ** 2)
        said.append(np.einsum("ndp,pq,ndq->nd", jacobians, estimate.covariance, jacobians))
    ratio = np.sqrt(
        np.mean(squares, axis=(0, 1)) / np.mean(said, axis=(0, 1))
    )  # for each coordinate
    assert np.all((ratio > 0.8) & (ratio < 1.2))
