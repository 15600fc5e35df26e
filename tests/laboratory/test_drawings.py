"""What the drawings of a page show."""

import re

import pytest

from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.report.page import _errors, draw_arm, draw_errors, draw_over_joints


@pytest.fixture(scope="module")
def result(calibrated):
    folder = calibrated.parent
    return calibrate_arm(folder / "arm.urdf", folder / "measurements.csv")


def test_drawings_name_their_axes_and_are_the_same_again(result):
    arm, longer = draw_arm(result)
    for text, labels in (
        (draw_errors(result), {"part of the rows", "cross-validated error [mm]"}),
        (draw_over_joints(result), {"position error [mm]", "lift [deg]", "elbow [deg]"}),
        (arm, {"from the side", "from above", "x [m]", "y [m]", "z [m]"}),
    ):
        assert labels <= {*re.findall(r">([^<>]+)</text>", text)} and text.startswith("<svg")
        assert "<metadata" not in text
    assert draw_arm(result) == (arm, longer)
    assert longer * max(_errors(result, 0, 1.0)["before"]) == pytest.approx(0.12, rel=0.5)
