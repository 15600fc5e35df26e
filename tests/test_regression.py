import warnings

import numpy as np
import pytest
from scipy.stats import norm
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct, WhiteKernel

from recalib.numerics import LENGTHS, NOISE, VARIANCES, Process, is_time_to_search

BOUNDS = np.log([VARIANCES, VARIANCES, *[LENGTHS] * 3, NOISE])
EPS = np.finfo(float).eps
GENERATOR = np.random.default_rng(1)
INPUTS = GENERATOR.uniform(-1, 1, (60, 3))
SMOOTH = np.stack([np.sin(2 * INPUTS[:, 0]) + INPUTS[:, 1], 3 + 5 * INPUTS[:, 1] ** 2], axis=1)


def test_a_smooth_function_is_found_where_it_was_not_seen():
    process = Process(INPUTS[:40], SMOOTH[:40])
    misses = process.predict(INPUTS[40:]) - SMOOTH[40:]
    assert np.all(np.std(misses, axis=0) < 0.03 * np.std(SMOOTH, axis=0))
    assert process.gain > 0
    for _ in range(4):
        assert Process(INPUTS[:20], GENERATOR.standard_normal((20, 1))).gain < 0


def test_the_gain_is_over_white_noise_less_what_hyperparameters_gain_by_chance():
    """By scikit-learn's own kernels and its own likelihood, and by SciPy's of white noise."""
    process = Process(INPUTS, SMOOTH)
    trend, smooth, *lengths, noise = np.exp(process.hyperparameters)
    kernel = ConstantKernel(trend) * DotProduct(1, "fixed") + ConstantKernel(smooth) * RBF(lengths)
    outputs = (SMOOTH - SMOOTH.mean(axis=0)) / SMOOTH.std(axis=0)
    regressor = GaussianProcessRegressor(kernel + WhiteKernel(noise), optimizer=None)
    found = regressor.fit(INPUTS - INPUTS.mean(axis=0), outputs).log_marginal_likelihood_value_
    schwarz = 6 / 2 * np.log(2 * 60)
    assert process.gain == pytest.approx(found - norm.logpdf(outputs).sum() - schwarz)


def test_hyperparameters_are_sought_at_powers_of_two_up_to_where_more_points_tell_little():
    sought = [points for points in range(1, 1000) if is_time_to_search(points - 1, points)]
    assert sought == [1, 2, 4, 8, 16, 32, 64, 128]
    assert is_time_to_search(40, 1000) and is_time_to_search(63, 64)
    assert not is_time_to_search(32, 63) and not is_time_to_search(128, 1000)


def test_the_unit_and_the_origin_of_outputs_and_the_origin_of_inputs_do_not_matter():
    shift, inputs = np.array([3, -1, 2]), INPUTS[:5] + 0.1
    # without noise, rounding would decide how likely the least noise is
    outputs = SMOOTH + np.random.default_rng(3).normal(scale=0.01, size=SMOOTH.shape)

    def differences(hyperparameters):
        process = Process(INPUTS, outputs, hyperparameters)
        other = Process(INPUTS + shift, 1e-3 * outputs - 5, hyperparameters)
        predicted = (other.predict(inputs + shift) + 5) / 1e-3
        return other.gain - process.gain, np.abs(predicted - process.predict(inputs)).max()

    assert np.allclose(differences(np.log([0.5, 2.0, 0.7, 1.5, 4.0, 0.01])), 0, atol=1e-9)
    # a search ends where the likelihood is flat: rounding moves its place, hardly what it is worth
    gain, predicted = differences(None)
    assert abs(gain) < 1e-5 and predicted < 1e-6


@pytest.mark.parametrize("count", [1, 2, 5, 6, 20])
def test_few_points_constant_inputs_and_exact_data_warn_of_nothing(count):
    inputs = INPUTS[:count].copy()
    inputs[:, 2] = 0.5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        predicted = Process(inputs, SMOOTH[:count]).predict(INPUTS)
    assert np.all(np.isfinite(predicted))


@pytest.mark.parametrize("noise", [1e-3, 0.1])
def test_no_hyperparameters_nearby_are_more_likely_than_those_that_are_found(noise):
    outputs = SMOOTH + np.random.default_rng(2).normal(scale=noise, size=SMOOTH.shape)
    found = Process(INPUTS, outputs)
    for step in (*np.eye(6), *-np.eye(6)):
        nearby = np.clip(found.hyperparameters + 0.2 * step, *BOUNDS.T)
        assert Process(INPUTS, outputs, nearby).gain <= found.gain + EPS * abs(found.gain)


def test_an_output_that_deviates_by_rounding_alone_is_constant():
    """Scaled to a deviation of one, it would look like a function that may be learned."""
    inputs = np.linspace(-1, 1, 12)[:, None]
    outputs = np.stack([np.sin(inputs[:, 0]), 1 + 6 * EPS * np.sign(inputs[:, 0])], axis=1)
    assert np.array_equal(Process(inputs, outputs)._scale[1:], [1.0])
