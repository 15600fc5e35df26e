import numpy as np
import pytest

from recalib import JOINT_WAVES, OFFSETS, Calibration
from recalib.identification import Identification, parameters_of
from recalib.identification.model import ErrorModel, Frames


@pytest.fixture
def calibration(robot) -> Calibration:
    """An elbow off by 3 degrees, a base by 4 mm, and nothing else that is known for sure."""
    model = ErrorModel(robot.arm, OFFSETS)
    parameters = np.full(len(model.deviations), 1e-5)
    parameters[0], parameters[model.offset_columns][2] = 4e-3, np.radians(3)
    deviations = np.full(len(parameters), 1e-4)
    estimate = Identification(
        parameters, np.diag(deviations**2), np.array([2e-4]), np.array([1.0, 1.0, 0.0]), 0.0, True
    )
    return Calibration(model, estimate)


def test_a_parameter_is_known_by_its_name_with_its_standard_error(calibration):
    named = {its.name: its for its in parameters_of(calibration.model, calibration.estimate)}
    elbow, base = (named[name] for name in ("offset of elbow_joint", "shift x of base"))
    assert (elbow.unit, base.unit) == ("deg", "mm")
    assert (elbow.value, base.value) == pytest.approx((3, 4))
    assert (elbow.deviation, base.deviation) == pytest.approx((np.degrees(1e-4), 0.1))


def test_every_parameter_has_a_name_of_its_own(robot):
    frames = Frames(targets=np.tile(np.eye(4), (2, 1, 1)), sockets=np.zeros((2, 3)))
    model = ErrorModel(robot.arm, JOINT_WAVES, frames)
    size = len(model.deviations)
    estimate = Identification(np.zeros(size), np.eye(size), np.ones(1), np.ones(1), 0.0, True)
    named = parameters_of(model, estimate, ("red", "blue"))
    assert len({its.name for its in named}) == size
    by_name = {its.name: its.unit for its in named}
    assert by_name["turn z of target blue"] == "deg" and by_name["sine 3 of wrist_1_joint"] == "deg"
    assert by_name["compliance of elbow_joint"] == "deg/Nm"
    assert next(name for name in by_name if "socket 1" in name).startswith("x of socket 1")
