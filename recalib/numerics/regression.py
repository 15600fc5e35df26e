"""Gaussian process regression, by scikit-learn, for several outputs with one covariance.

The covariance is that of a linear trend, a smooth function with a length along each input, and
white noise. The outputs are scaled to a deviation of one. The hyperparameters are the logarithms of
the trend's variance, of the smooth function's, of its lengths and of the noise's variance.
"""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from sklearn.gaussian_process import GaussianProcessRegressor

VARIANCES, LENGTHS, NOISE = (1e-4, 1e6), (0.3, 1e2), (1e-9, 1e1)  # their bounds
FIRST_LENGTH = 5.0
# Where searches start: from one alone, few data may all be taken for noise.
FIRST_NOISES = 1e-3, 1e-1, 1e-6
FEWEST = 6  # points to judge hyperparameters by
# Points to judge hyperparameters by: the time grows with their cube, and more tell little more.
MOST = 128
STEPS = 50  # of a search
ROUNDING = 10 * np.finfo(float).eps  # an output that deviates by less is constant: not to be scaled


def is_time_to_search(before: int, points: int) -> bool:
    """Whether to search hyperparameters anew.

    It is time when the number of points passes a power of two, unless it was `MOST` or more before.
    """
    return points.bit_length() > before.bit_length() and before < MOST


class Process:
    """A Gaussian process through training data.

    Args:
        inputs: (n, d), each of the order of one.
        outputs: (n, k), in any unit.
        hyperparameters: (d + 3,); those of the largest marginal likelihood unless given.

    Attributes:
        hyperparameters: (d + 3,) as used.
        gain: by how much the logarithm of the marginal likelihood exceeds that of white noise, less
            what so many hyperparameters gain by chance (Schwarz's criterion).
    """

    def __init__(
        self, inputs: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray | None = None
    ):
        self._inputs, self._outputs = inputs, outputs
        self._centre, self._mean = inputs.mean(axis=0), outputs.mean(axis=0)
        deviations = outputs.std(axis=0)
        self._scale = np.where(deviations > ROUNDING, deviations, 1)
        inputs, outputs = inputs - self._centre, (outputs - self._mean) / self._scale
        if hyperparameters is None:
            hyperparameters = (
                _search(inputs[:MOST], outputs[:MOST])
                if len(inputs) >= FEWEST
                else _start(inputs.shape[1])
            )
        self.hyperparameters = hyperparameters
        self._regressor = _regressor(inputs, outputs, hyperparameters)
        white = -outputs.size / 2 * (np.log(2 * np.pi) + 1)
        chance = len(hyperparameters) / 2 * np.log(outputs.size)
        self.gain = self._regressor.log_marginal_likelihood_value_ - white - chance

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Expected outputs (m, k) at inputs (m, d)."""
        # The regressor's own `predict` checks and copies for longer than it computes.
        regressor = self._regressor
        expected = regressor.kernel_(inputs - self._centre, regressor.X_train_) @ regressor.alpha_
        return self._mean + expected * self._scale

    def state(self) -> dict[str, np.ndarray]:
        """The arguments that make it again, as named arrays."""
        return {
            "inputs": self._inputs,
            "outputs": self._outputs,
            "hyperparameters": self.hyperparameters,
        }


def _start(dimensions: int, noise: float = FIRST_NOISES[0]) -> np.ndarray:
    return np.log([1.0, 1.0, *[FIRST_LENGTH] * dimensions, noise])


def _regressor(
    inputs: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray
) -> "GaussianProcessRegressor":
    # Most of a second to import, with pandas: who does not regress need not wait for it.
    from sklearn.gaussian_process import GaussianProcessRegressor

    from recalib.numerics.covariance import Covariance

    return GaussianProcessRegressor(Covariance(hyperparameters), optimizer=None).fit(
        inputs, outputs
    )


def _search(inputs: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Hyperparameters of the largest marginal likelihood that searches within the bounds find.

    A bound that is reached (an input that does not matter, no noise) is an answer, not a failure.
    """
    from scipy.optimize import minimize  # comes with scikit-learn, and as late

    dimensions = inputs.shape[1]
    starts = [_start(dimensions, noise) for noise in FIRST_NOISES]
    regressor = _regressor(inputs, outputs, starts[0])

    def loss(hyperparameters: np.ndarray) -> tuple[float, np.ndarray]:
        value, slope = regressor.log_marginal_likelihood(
            hyperparameters, eval_gradient=True, clone_kernel=False
        )
        return -value, -slope

    bounds = np.log([VARIANCES, VARIANCES, *[LENGTHS] * dimensions, NOISE])
    found = [
        minimize(loss, start, jac=True, bounds=bounds, options={"maxiter": STEPS})
        for start in starts
    ]
    return min(found, key=lambda result: result.fun).x
