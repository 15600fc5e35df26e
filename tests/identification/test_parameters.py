from dataclasses import replace

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
    elbow, base = (
        calibration.parameters[name] for name in ("offset of elbow_joint", "shift x of base")
    )
    assert (elbow.unit, base.unit) == ("deg", "mm")
    assert (elbow.value, base.value) == pytest.approx((3, 4))
    assert (elbow.deviation, base.deviation) == pytest.approx((np.degrees(1e-4), 0.1))


def test_what_is_held_at_nominal_is_no_parameter(calibration):
    held = calibration.model.deviations.copy()
    held[calibration.model.offset_columns] = 0.0
    calibration.model.deviations = held
    assert not [name for name in calibration.parameters if name.startswith("offset")]


def test_a_summary_lists_what_is_clearly_not_zero_and_counts_the_rest(calibration):
    text = calibration.summary()
    assert "observations: 3, 1 of them outliers\nnoise along an axis: 0.2 mm\n" in text
    rows = text.partition("std err\n")[2].splitlines()
    assert [row.split() for row in rows[:-1]] == [
        ["shift", "x", "of", "base", "4.0000", "0.1000", "mm"],
        ["offset", "of", "elbow_joint", "3.0000", "0.0057", "deg"],
    ]
    assert rows[-1] == f"and {len(calibration.parameters) - 2} within 2 standard errors of zero"
    unsettled = replace(calibration, estimate=replace(calibration.estimate, converged=False))
    assert "converged: yes" in text and "converged: no" in unsettled.summary()


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
