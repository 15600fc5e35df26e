"""What a model may explain, when a richer one is taken, and what is kept of a calibration."""

import numpy as np
import pytest

import recalib
from recalib.identification import Identification, calibrate, parameters_of
from recalib.identification.model import ErrorModel, Frames
from tests.identification.test_estimation import noisy, postures

EXACT = recalib.Disturbances(recalib.Noise(1e-5, 1e-4))


def test_joint_errors_are_believed_to_be_as_large_as_those_of_worn_arms(robot, controller):
    """By their largest over the workspace: of a gear out of centre half a degree, and so on."""
    angles = postures(controller, 50)
    model = ErrorModel(robot.arm, recalib.JOINT_WAVES)
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
            robot.arm,
            (recalib.OFFSETS, recalib.JOINT_ERRORS),
            recalib.Observations(angles, noisy(damaged, angles, seed)),
        )
        assert found.model.names == ("offset",) and found.pattern is None


def test_where_more_is_wrong_the_model_that_says_it_is_used(robot, controller):
    angles = postures(controller, 24)
    bent = recalib.apply(robot, [recalib.Sag(joint, 1e-4) for joint in robot.joints])
    observations = recalib.Observations(angles, noisy(bent, angles, 1))
    found = calibrate(robot.arm, (recalib.OFFSETS, recalib.JOINT_ERRORS), observations)
    assert len(found.model.names) == len(recalib.JOINT_ERRORS)
    compliance = found.model.coefficients(found.estimate.parameters)["compliance"]
    assert compliance[1:3] == pytest.approx([-1e-4] * 2, rel=0.1)


@pytest.fixture(scope="module")
def geared(robot, controller):
    """An arm of eccentric gears, postures, and what was measured there, one of them grossly off."""
    arm = recalib.apply(robot, [recalib.EccentricGear(joint, 0.01, 0.5) for joint in robot.joints])
    angles = postures(controller, 60)
    measured = noisy(arm, angles, 7, EXACT)
    measured[20, :3, 3] += 0.1, 0.0, -0.1
    return arm, angles, measured


def test_what_no_term_explains_is_left_to_a_process_in_position_and_orientation(robot, geared):
    arm, angles, measured = geared
    found = calibrate(robot.arm, (recalib.OFFSETS,), recalib.Observations(angles, measured))
    asked, true = angles + 0.02, arm.forward(angles + 0.02)
    alone = recalib.Calibration(found.model, found.estimate).forward(asked)
    for error in (recalib.position_error, recalib.orientation_error):
        assert error(found.forward(asked), true).mean() < 0.3 * error(alone, true).mean()
    moved = found.forward(angles)[20] - arm.forward(angles)[20]
    assert np.abs(moved[:3, 3]).max() < 2e-3, "no pattern is learned from a doubted measurement"


@pytest.fixture
def calibration(robot) -> recalib.Calibration:
    """An elbow off by 3 degrees, a base by 4 mm, and nothing else that is known for sure."""
    model = ErrorModel(robot.arm, recalib.OFFSETS)
    parameters = np.full(len(model.deviations), 1e-5)
    parameters[0], parameters[model.offset_columns][2] = 4e-3, np.radians(3)
    deviations = np.full(len(parameters), 1e-4)
    estimate = Identification(
        parameters, np.diag(deviations**2), np.array([2e-4]), np.array([1.0, 1.0, 0.0]), 0.0, True
    )
    return recalib.Calibration(model, estimate)


def test_a_parameter_is_known_by_its_name_with_its_standard_error(calibration):
    names = "offset of elbow_joint", "shift x of base"
    parameters = parameters_of(calibration.model, calibration.estimate)
    named = {parameter.name: parameter for parameter in parameters}
    elbow, base = (named[name] for name in names)
    assert (elbow.unit, base.unit) == ("deg", "mm")
    assert (elbow.value, base.value) == pytest.approx((3, 4))
    assert (elbow.deviation, base.deviation) == pytest.approx((np.degrees(1e-4), 0.1))


def test_every_parameter_has_a_name_of_its_own(robot):
    frames = Frames(targets=np.tile(np.eye(4), (2, 1, 1)), sockets=np.zeros((2, 3)))
    model = ErrorModel(robot.arm, recalib.JOINT_WAVES, frames)
    size = len(model.deviations)
    estimate = Identification(np.zeros(size), np.eye(size), np.ones(1), np.ones(1), 0.0, True)
    named = parameters_of(model, estimate, ("red", "blue"))
    assert len({parameter.name for parameter in named}) == size
    by_name = {parameter.name: parameter.unit for parameter in named}
    assert by_name["turn z of target blue"] == "deg" and by_name["sine 3 of wrist_1_joint"] == "deg"
    assert by_name["compliance of elbow_joint"] == "deg/Nm"
    assert next(name for name in by_name if "socket 1" in name).startswith("x of socket 1")
