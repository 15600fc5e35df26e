from dataclasses import replace

import numpy as np
import pytest

from recalib import OFFSETS, Calibration, Observations, information_gains
from recalib.identification import identify, most_informative
from recalib.identification.model import ErrorModel
from tests.identification.test_estimation import postures


@pytest.fixture
def angles(controller):
    return postures(controller, 9)


@pytest.fixture(params=["poses", "positions"])
def calibration(request, robot, damaged, angles):
    model, measured = ErrorModel(robot.arm, OFFSETS), damaged.forward(angles[:3])
    measured = measured if request.param == "poses" else measured[:, :3, 3]
    return Calibration(model, identify(model, Observations(angles[:3], measured)))


def test_each_of_a_set_is_the_best_given_those_before_it(calibration, angles):
    left, known = {*range(len(angles))}, calibration
    for number, covariance in most_informative(calibration, angles, 20):
        gains = information_gains(known, angles)
        assert number == max(left, key=gains.__getitem__)
        left.remove(number)
        before = np.linalg.slogdet(known.estimate.covariance).logabsdet
        shrunk = (before - np.linalg.slogdet(covariance).logabsdet) / 2
        assert shrunk == pytest.approx(gains[number], rel=1e-6)
        known = replace(calibration, estimate=replace(known.estimate, covariance=covariance))
    assert not left
