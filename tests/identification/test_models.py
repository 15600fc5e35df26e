"""What a model may explain, when a richer one is taken, and what is kept of a calibration."""

import numpy as np
import pytest

from recalib import (
    JOINT_ERRORS,
    JOINT_WAVES,
    OFFSETS,
    Calibration,
    Disturbances,
    EccentricGear,
    Noise,
    Observations,
    Sag,
    apply,
    orientation_error,
    position_error,
)
from recalib.identification import calibrate
from recalib.identification.model import ErrorModel
from tests.identification.test_estimation import noisy, postures

EXACT = Disturbances(Noise(1e-5, 1e-4))


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
    measured = noisy(arm, angles, 7, EXACT)
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
