"""Gaussian process regression, for several outputs with one covariance.

The covariance is that of a linear trend, a smooth function with a length along each input, and
white noise. The outputs are scaled to a deviation of one. The hyperparameters are the logarithms of
the trend's variance, of the smooth function's, of its lengths and of the noise's variance.

scikit-learn has the same, and takes a second to import; a test holds ours to it.
"""

import numpy as np
import scipy.linalg

VARIANCES, LENGTHS, NOISE = (1e-4, 1e6), (0.3, 1e2), (1e-9, 1e1)  # their bounds
FIRST_LENGTH = 5.0
# Where searches start: from one alone, few data may all be taken for noise.
FIRST_NOISES = 1e-3, 1e-1, 1e-6
FEWEST = 6  # points to judge hyperparameters by
# Points to judge hyperparameters by: the time grows with their cube, and more tell little more.
MOST = 128
STEPS = 50  # of a search
ROUNDING = 10 * np.finfo(float).eps  # an output that deviates by less is constant: not to be scaled
JITTER = 1e-10  # on the diagonal of covariances: without noise, rounding would make them singular


def is_time_to_search(before: int, points: int) -> bool:
    """Whether to search hyperparameters anew: the points have doubled since there were `before`."""
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
        self._points = inputs
        self._weights, likelihood, *_ = _fitted(inputs, outputs, hyperparameters)
        white = -outputs.size / 2 * (np.log(2 * np.pi) + 1)
        chance = len(hyperparameters) / 2 * np.log(outputs.size)
        self.gain = likelihood - white - chance

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Expected outputs (m, k) at inputs (m, d)."""
        parts = covariance_parts(self.hyperparameters, inputs - self._centre, self._points)
        return self._mean + sum(parts) @ self._weights * self._scale

    def state(self) -> dict[str, np.ndarray]:
        """The arguments that make it again, as named arrays."""
        return {
            "inputs": self._inputs,
            "outputs": self._outputs,
            "hyperparameters": self.hyperparameters,
        }


def _start(dimensions: int, noise: float = FIRST_NOISES[0]) -> np.ndarray:
    return np.log([1.0, 1.0, *[FIRST_LENGTH] * dimensions, noise])


def covariance_parts(
    hyperparameters: np.ndarray, points: np.ndarray, others: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariances (n, m) of points (n, d) with others (m, d): of the trend, and of what is smooth.

    Those of points with themselves have noise besides.
    """
    from scipy.spatial.distance import cdist  # slow to import: who does not regress need not wait

    trend, smooth, *lengths, _ = np.exp(hyperparameters)
    squares = cdist(points / lengths, others / lengths, "sqeuclidean")
    return trend * (1 + points @ others.T), smooth * np.exp(-squares / 2)


def _fitted(
    inputs: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Weights (n, k) of the points, and the logarithm of the marginal likelihood.

    And the lower factor of the covariances, and their parts.
    """
    linear, bell = covariance_parts(hyperparameters, inputs, inputs)
    covariances = linear + bell
    diagonal = np.diag_indices_from(covariances)
    covariances[diagonal] += np.exp(hyperparameters[-1])
    covariances[diagonal] += JITTER
    factor = scipy.linalg.cholesky(covariances, lower=True, check_finite=False)
    weights = scipy.linalg.cho_solve((factor, True), outputs, check_finite=False)
    by_output = -np.einsum("ik,ik->k", outputs, weights) / 2
    by_output -= np.log(np.diag(factor)).sum()
    by_output -= len(inputs) / 2 * np.log(2 * np.pi)
    return weights, by_output.sum(), factor, (linear, bell)


def likelihood_and_slope(
    inputs: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray
) -> tuple[float, np.ndarray]:
    """The logarithm of the marginal likelihood, and its slope (d + 3,) by the hyperparameters.

    Minus infinity where rounding leaves a singular matrix.
    """
    try:
        weights, likelihood, factor, parts = _fitted(inputs, outputs, hyperparameters)
    except np.linalg.LinAlgError:
        return -np.inf, np.zeros_like(hyperparameters)
    (linear, bell), (_, _, *lengths, noise) = parts, np.exp(hyperparameters)
    by_length = bell[..., None] * np.square((inputs[:, None] - inputs) / lengths)
    slopes = np.dstack([linear, bell, by_length, noise * np.eye(len(inputs))])
    inner = np.einsum("ik,jk->ijk", weights, weights)
    inverse = scipy.linalg.cho_solve((factor, True), np.eye(len(inputs)), check_finite=False)
    inner -= inverse[..., None]
    return likelihood, (np.einsum("ijl,jik->kl", inner, slopes) / 2).sum(axis=-1)


def _search(inputs: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Hyperparameters of the largest marginal likelihood that searches within the bounds find.

    A bound that is reached (an input that does not matter, no noise) is an answer, not a failure.
    """
    from scipy.optimize import minimize  # slow to import, too

    def loss(hyperparameters: np.ndarray) -> tuple[float, np.ndarray]:
        value, slope = likelihood_and_slope(inputs, outputs, hyperparameters)
        return -value, -slope

    dimensions, options = inputs.shape[1], {"maxiter": STEPS}
    bounds = np.log([VARIANCES, VARIANCES, *[LENGTHS] * dimensions, NOISE])
    found = [
        minimize(loss, _start(dimensions, noise), jac=True, bounds=bounds, options=options)
        for noise in FIRST_NOISES
    ]
    return min(found, key=lambda result: result.fun).x
