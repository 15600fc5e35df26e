import warnings

import numpy as np
import pytest
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct, WhiteKernel

from recalib.regression import Covariance, Process

GENERATOR = np.random.default_rng(1)
INPUTS = GENERATOR.uniform(-1, 1, (60, 3))
SMOOTH = np.stack([np.sin(2 * INPUTS[:, 0]) + INPUTS[:, 1], 3 + 5 * INPUTS[:, 1] ** 2], axis=1)


def test_a_smooth_function_is_found_where_it_was_not_seen():
    process = Process(INPUTS[:40], SMOOTH[:40])
    misses = process.predict(INPUTS[40:]) - SMOOTH[40:]
    assert np.all(np.std(misses, axis=0) < 0.03 * np.std(SMOOTH, axis=0))
    assert process.gain > 0


def test_noise_is_no_gain():
    assert Process(INPUTS, GENERATOR.standard_normal((60, 2))).gain < 0


def test_known_hyperparameters_are_used_as_they_are():
    found = Process(INPUTS, SMOOTH)
    again = Process(**found.state())
    assert np.array_equal(again.predict(INPUTS), found.predict(INPUTS))
    assert np.array_equal(again.hyperparameters, found.hyperparameters)


@pytest.mark.parametrize("count", [1, 2, 5, 6, 20])
def test_few_points_constant_inputs_and_exact_data_warn_of_nothing(count):
    inputs = INPUTS[:count].copy()
    inputs[:, 2] = 0.5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        predicted = Process(inputs, SMOOTH[:count]).predict(INPUTS)
    assert np.all(np.isfinite(predicted))


def test_the_covariance_is_that_of_the_kernels_it_is_made_of():
    theta = np.log([0.5, 2.0, 0.7, 1.5, 4.0, 0.01])
    parts = (
        ConstantKernel(0.5) * DotProduct(1, "fixed")
        + ConstantKernel(2.0) * RBF([0.7, 1.5, 4.0])
        + WhiteKernel(0.01)
    )
    assert np.allclose(parts.theta, theta)
    ours = Covariance(theta)
    for own, theirs in zip(
        ours(INPUTS, eval_gradient=True), parts(INPUTS, eval_gradient=True), strict=True
    ):
        assert np.allclose(own, theirs, atol=1e-12)
    assert np.allclose(ours(INPUTS[:5], INPUTS), parts(INPUTS[:5], INPUTS), atol=1e-12)
    assert np.allclose(ours.diag(INPUTS), parts.diag(INPUTS), atol=1e-12)
