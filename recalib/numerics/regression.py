"""Gaussian process regression, for several outputs with one covariance.

The covariance is the sum of those of a linear trend, of a smooth function with a length scale along
each input, and of white noise. The outputs are scaled to a standard deviation of one. The
hyperparameters are the logarithms of the trend's variance, the smooth function's variance, its
length scales and the noise's variance.
"""

import numpy as np
import scipy

VARIANCES, LENGTHS, NOISE = (1e-4, 1e6), (0.3, 1e2), (1e-9, 1e1)  # bounds of the hyperparameters
FIRST_LENGTH = 5.0
# The starts of a search: from a single start, a few data may all be mistaken for noise.
FIRST_NOISES = 1e-3, 1e-1, 1e-6
FEWEST = 6  # the least number of points for a search of hyperparameters
MOST = 128  # points for a search: its time grows with their cube, and more add little
STEPS = 50  # of a search
ROUNDING = 10 * np.finfo(float).eps  # an output that deviates by less is constant and not scaled
JITTER = 1e-10  # on the diagonal: with exact data, the matrix is numerically singular


def is_time_to_search(before: int, points: int) -> bool:
    """Whether to search for hyperparameters again.

    It is time when the number of points has passed a power of two, unless it was `MOST` or more.
    """
    return points.bit_length() > before.bit_length() and before < MOST


class Process:
    """A Gaussian process, conditioned on training data.

    Args:
        inputs: (n, d), each of the order of one.
        outputs: (n, k), in any unit.
        hyperparameters: (d + 3,); default: those of the largest marginal likelihood.

    Attributes:
        hyperparameters: (d + 3,) as used.
        gain: the log marginal likelihood minus that of white noise, minus the expected gain of so
            many hyperparameters by chance (Schwarz's criterion).
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
            hyperparameters = _search(inputs[:MOST], outputs[:MOST])
        self.hyperparameters = hyperparameters
        self._centred = inputs
        likelihood, self._weights, *_ = _likelihood(hyperparameters, inputs, outputs)
        white = -outputs.size / 2 * (np.log(2 * np.pi) + 1)
        chance = len(hyperparameters) / 2 * np.log(outputs.size)
        self.gain = likelihood - white - chance

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Expected outputs (m, k) at inputs (m, d)."""
        linear, bell = _covariances(self.hyperparameters, inputs - self._centre, self._centred)
        return self._mean + (linear + bell) @ self._weights * self._scale

    def state(self) -> dict[str, np.ndarray]:
        """The arguments that reproduce the process, as named arrays."""
        return {
            "inputs": self._inputs,
            "outputs": self._outputs,
            "hyperparameters": self.hyperparameters,
        }


def _start(dimensions: int, noise: float = FIRST_NOISES[0]) -> np.ndarray:
    return np.log([1.0, 1.0, *[FIRST_LENGTH] * dimensions, noise])


def _covariances(
    hyperparameters: np.ndarray, inputs: np.ndarray, others: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariances (n, m) of trend and smooth function between points (n, d) and others (m, d)."""
    sizes = np.exp(hyperparameters)
    trend, smooth, lengths = sizes[0], sizes[1], sizes[2:-1]
    squares = scipy.spatial.distance.cdist(inputs / lengths, others / lengths, "sqeuclidean")
    return trend * (1 + inputs @ others.T), smooth * np.exp(-squares / 2)


def _likelihood(
    hyperparameters: np.ndarray, inputs: np.ndarray, outputs: np.ndarray
) -> tuple[float, np.ndarray, tuple[np.ndarray, bool], np.ndarray, np.ndarray]:
    """The logarithm of the marginal likelihood, and intermediate results.

    These are the weights (n, k) of the points, the Cholesky factor of their covariance, and the
    trend's and the smooth function's parts of the covariance.

    Raises LinAlgError if the covariance is singular.
    """
    linear, bell = _covariances(hyperparameters, inputs, inputs)
    noise = (np.exp(hyperparameters[-1]) + JITTER) * np.eye(len(inputs))
    factor = scipy.linalg.cho_factor(linear + bell + noise, lower=True, check_finite=False)
    weights = scipy.linalg.cho_solve(factor, outputs, check_finite=False)
    volume = outputs.shape[1] * np.log(np.diag(factor[0])).sum()
    squares = np.sum(outputs * weights) + outputs.size * np.log(2 * np.pi)
    return -squares / 2 - volume, weights, factor, linear, bell


def _loss(
    hyperparameters: np.ndarray, inputs: np.ndarray, outputs: np.ndarray
) -> tuple[float, np.ndarray]:
    """The negative logarithm of the marginal likelihood, and its gradient (d + 3,).

    Its component for a hyperparameter is tr((k K^-1 - W W') dK) / 2, with the weights W.
    """
    try:
        value, weights, factor, *parts = _likelihood(hyperparameters, inputs, outputs)
    except np.linalg.LinAlgError:  # rounding has made the covariance indefinite
        return np.inf, np.zeros_like(hyperparameters)
    inverse = scipy.linalg.cho_solve(factor, np.eye(len(inputs)), check_finite=False)
    by_covariance = outputs.shape[1] * inverse - weights @ weights.T
    trend, smooth = (by_covariance * part for part in parts)
    sizes = np.exp(hyperparameters)
    places = inputs / sizes[2:-1]
    by_length = smooth.sum(axis=0) @ places**2 - np.sum(places * (smooth @ places), axis=0)
    by_noise = sizes[-1] * np.trace(by_covariance) / 2
    return -value, np.array([trend.sum() / 2, smooth.sum() / 2, *by_length, by_noise])


def _search(inputs: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Hyperparameters of the largest marginal likelihood within the bounds, from several searches.

    A result at a bound (an irrelevant input, no noise) is valid, not a failure. For fewer points
    than `FEWEST`, the start of a search.
    """
    if len(inputs) < FEWEST:
        return _start(inputs.shape[1])
    dimensions = inputs.shape[1]
    bounds = np.log([VARIANCES, VARIANCES, *[LENGTHS] * dimensions, NOISE])
    starts = [_start(dimensions, noise) for noise in FIRST_NOISES]
    settings = {"jac": True, "bounds": bounds, "options": {"maxiter": STEPS}}
    found = [
        scipy.optimize.minimize(_loss, start, (inputs, outputs), **settings) for start in starts
    ]
    return min(found, key=lambda result: result.fun).x
