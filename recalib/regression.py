"""Gaussian process regression for several outputs with one covariance.

The covariance is that of a linear trend, a smooth function with a length along each input, and
white noise. The outputs are scaled to a deviation of one. The hyperparameters are the logarithms of
the trend's variance, of the smooth function's, of its lengths and of the noise's variance. The
equations are those of Rasmussen and Williams (2006), Gaussian Processes for Machine Learning.
"""

import numpy as np
from scipy.linalg import cho_solve, cholesky
from scipy.spatial.distance import cdist

VARIANCES, LENGTHS, NOISE = (1e-4, 1e6), (0.3, 1e2), (1e-9, 1e1)  # their bounds
FIRST_LENGTH = 5.0
# Where searches start: from one alone, few data may all be taken for noise.
FIRST_NOISES = 1e-3, 1e-1, 1e-6
FEWEST = 6  # points to judge hyperparameters by
# Points to judge hyperparameters by: the time grows with their cube, and more tell little more.
MOST = 128
STEPS = 50  # of a search
ROUNDING = 10 * np.finfo(float).eps  # an output that deviates by less is constant: not to be scaled
REGULAR = 1e-10  # a variance that every point has, lest exact data make singular equations


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
        likelihood = Likelihood(inputs, outputs, hyperparameters)
        self._points, self._weights = inputs, likelihood.weights
        white = -outputs.size / 2 * (np.log(2 * np.pi) + 1)
        chance = len(hyperparameters) / 2 * np.log(outputs.size)
        self.gain = likelihood.value - white - chance

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Expected outputs (m, k) at inputs (m, d)."""
        linear, bell = _parts(inputs - self._centre, self._points, self.hyperparameters)
        expected = (linear + bell) @ self._weights
        return self._mean + expected * self._scale

    def state(self) -> dict[str, np.ndarray]:
        """The arguments that make it again, as named arrays."""
        return {
            "inputs": self._inputs,
            "outputs": self._outputs,
            "hyperparameters": self.hyperparameters,
        }


class Likelihood:
    """The marginal likelihood of hyperparameters, given training data.

    Args:
        inputs: (n, d).
        outputs: (n, k), each of mean zero and a deviation of one.
        hyperparameters: (d + 3,).

    Attributes:
        value: its logarithm.
        weights: (n, k) of the training points in what is expected elsewhere.

    Raises numpy.linalg.LinAlgError: the covariances are singular but for rounding.
    """

    def __init__(self, inputs: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray):
        self._inputs, self._hyperparameters = inputs, hyperparameters
        self._linear, self._bell = _parts(inputs, inputs, hyperparameters)
        self._white = np.exp(hyperparameters[-1]) * np.eye(len(inputs))
        covariances = self._linear + self._bell + self._white
        covariances[np.diag_indices_from(covariances)] += REGULAR
        self._factor = cholesky(covariances, lower=True, check_finite=False), True
        self.weights = cho_solve(self._factor, outputs, check_finite=False)
        each = -0.5 * np.einsum("ik,ik->k", outputs, self.weights)
        each -= np.log(np.diag(self._factor[0])).sum()
        each -= len(inputs) / 2 * np.log(2 * np.pi)
        self.value = each.sum()

    def slope(self) -> np.ndarray:
        """Of the logarithm, by the hyperparameters (d + 3,)."""
        lengths = np.exp(self._hyperparameters[2:-1])
        by_length = np.square((self._inputs[:, None] - self._inputs) / lengths)
        by_length *= self._bell[..., None]
        slopes = np.dstack([self._linear, self._bell, by_length, self._white])
        inverse = cho_solve(self._factor, np.eye(len(self._inputs)), check_finite=False)
        outer = np.einsum("ik,jk->ijk", self.weights, self.weights) - inverse[..., None]
        return 0.5 * np.einsum("ijl,jik->kl", outer, slopes).sum(axis=-1)


def _parts(
    points: np.ndarray, others: np.ndarray, hyperparameters: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariances (n, m) of points (n, d) and others (m, d): the trend's, the smooth function's."""
    trend, smooth, *lengths, _ = np.exp(hyperparameters)
    bell = smooth * np.exp(-cdist(points / lengths, others / lengths, "sqeuclidean") / 2)
    return trend * (1 + points @ others.T), bell


def _start(dimensions: int, noise: float = FIRST_NOISES[0]) -> np.ndarray:
    return np.log([1.0, 1.0, *[FIRST_LENGTH] * dimensions, noise])


def _search(inputs: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Hyperparameters of the largest marginal likelihood that searches within the bounds find.

    A bound that is reached (an input that does not matter, no noise) is an answer, not a failure.
    """
    from scipy.optimize import minimize  # a tenth of a second, which only searches need

    dimensions = inputs.shape[1]

    def loss(hyperparameters: np.ndarray) -> tuple[float, np.ndarray]:
        try:
            likelihood = Likelihood(inputs, outputs, hyperparameters)
        except np.linalg.LinAlgError:
            return np.inf, np.zeros_like(hyperparameters)
        return -likelihood.value, -likelihood.slope()

    bounds = np.log([VARIANCES, VARIANCES, *[LENGTHS] * dimensions, NOISE])
    found = [
        minimize(
            loss, _start(dimensions, noise), jac=True, bounds=bounds, options={"maxiter": STEPS}
        )
        for noise in FIRST_NOISES
    ]
    return min(found, key=lambda result: result.fun).x
