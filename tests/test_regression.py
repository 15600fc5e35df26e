import warnings

import numpy as np
import pytest
from scipy.stats import norm
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct, WhiteKernel

from recalib.numerics.regression import Process, _loss, is_time_to_search

EPS = np.finfo(float).eps
GENERATOR = np.random.default_rng(1)
INPUTS = GENERATOR.uniform(-1, 1, (60, 3))
SMOOTH = np.stack([np.sin(2 * INPUTS[:, 0]) + INPUTS[:, 1], 3 + 5 * INPUTS[:, 1] ** 2], axis=1)


def test_a_smooth_function_is_found_where_it_was_not_seen():
    process = Process(INPUTS[:40], SMOOTH[:40])
    misses = process.predict(INPUTS[40:]) - SMOOTH[40:]
    assert np.all(np.std(misses, axis=0) < 0.03 * np.std(SMOOTH, axis=0))
    assert process.gain > 0


def test_noise_is_no_gain():
    for _ in range(4):
        assert Process(INPUTS[:20], GENERATOR.standard_normal((20, 1))).gain < 0


def by_scikit_learn(inputs, outputs, hyperparameters) -> GaussianProcessRegressor:
    """The same process, of kernels that others wrote."""
    trend, smooth, *lengths, noise = np.exp(hyperparameters)
    kernel = ConstantKernel(trend) * DotProduct(1, "fixed") + ConstantKernel(smooth) * RBF(lengths)
    return GaussianProcessRegressor(kernel + WhiteKernel(noise), optimizer=None).fit(
        inputs, outputs
    )


def test_predictions_and_the_gain_over_white_noise_are_those_of_scikit_learn():
    process, asked = Process(INPUTS, SMOOTH), INPUTS[:5] + 0.1
    mean, scale, centre = SMOOTH.mean(axis=0), SMOOTH.std(axis=0), INPUTS.mean(axis=0)
    outputs = (SMOOTH - mean) / scale
    other = by_scikit_learn(INPUTS - centre, outputs, process.hyperparameters)
    predicted = mean + scale * other.predict(asked - centre)
    assert process.predict(asked) == pytest.approx(predicted, abs=1e-9)
    schwarz = 6 / 2 * np.log(2 * 60)  # what so many hyperparameters gain by chance
    white = norm.logpdf(outputs).sum()
    assert process.gain == pytest.approx(other.log_marginal_likelihood_value_ - white - schwarz)


def test_a_search_goes_by_the_likelihood_and_its_slopes():
    theta = np.log([0.5, 2.0, 0.7, 1.5, 4.0, 0.01])
    other = by_scikit_learn(INPUTS, SMOOTH, theta)
    likelihood, slopes = other.log_marginal_likelihood(theta, eval_gradient=True)
    loss, by_theta = _loss(theta, INPUTS, SMOOTH)
    assert loss == pytest.approx(-likelihood) and by_theta == pytest.approx(-slopes)


def test_hyperparameters_are_sought_when_the_points_have_doubled_up_to_where_they_tell_little():
    sought = [points for points in range(1, 1000) if is_time_to_search(points - 1, points)]
    assert sought == [1, 2, 4, 8, 16, 32, 64, 128]
    assert is_time_to_search(40, 1000) and not is_time_to_search(40, 63)


def test_the_unit_and_the_origin_of_outputs_and_the_origin_of_inputs_do_not_matter():
    shift, asked = np.array([3, -1, 2]), INPUTS[:5] + 0.1

    def differences(hyperparameters):
        process = Process(INPUTS, SMOOTH, hyperparameters)
        other = Process(INPUTS + shift, 1e-3 * SMOOTH - 5, hyperparameters)
        predicted = (other.predict(asked + shift) + 5) / 1e-3
        return other.gain - process.gain, np.abs(predicted - process.predict(asked)).max()

    assert np.allclose(differences(np.log([0.5, 2.0, 0.7, 1.5, 4.0, 0.01])), 0, atol=1e-9)
    # a search ends where the likelihood is flat: rounding moves its place, hardly what it is worth
    gain, predicted = differences(None)
    assert abs(gain) < 1e-2 and predicted < 1e-4


@pytest.mark.parametrize("count", [1, 2, 5, 6, 20])
def test_few_points_constant_inputs_and_exact_data_warn_of_nothing(count):
    inputs = INPUTS[:count].copy()
    inputs[:, 2] = 0.5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        predicted = Process(inputs, SMOOTH[:count]).predict(INPUTS)
    assert np.all(np.isfinite(predicted))


def test_an_output_that_deviates_by_rounding_alone_is_constant():
    """Scaled to a deviation of one, it would look like a function that may be learned."""
    inputs = np.linspace(-1, 1, 12)[:, None]
    outputs = np.stack([np.sin(inputs[:, 0]), 1 + 6 * EPS * np.sign(inputs[:, 0])], axis=1)
    assert np.array_equal(Process(inputs, outputs)._scale[1:], [1.0])
