"""Gaussian process regression for several outputs with one covariance.

After Rasmussen and Williams (2006, algorithms 2.1 and 5.1). The covariance is that of a linear
trend, a smooth function with a length along each input, and white noise. The outputs are scaled to
a deviation of one. The hyperparameters are the logarithms of the trend's variance, of the smooth
function's, of its lengths and of the noise's variance.
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
JITTER = 1e-10  # added to the variances of outputs, for a factor to exist
ROUNDING = 10 * np.finfo(float).eps  # an output that deviates by less is constant: not to be scaled


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
        self._centred = inputs
        linear, bell = _covariances(inputs, inputs, hyperparameters)
        _, self._weights, likelihood = _condition(linear + bell, outputs, hyperparameters)
        white = -outputs.size / 2 * (np.log(2 * np.pi) + 1)
        chance = len(hyperparameters) / 2 * np.log(outputs.size)
        self.gain = likelihood - white - chance

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Expected outputs (m, k) at inputs (m, d)."""
        inputs = inputs - self._centre
        linear, bell = _covariances(inputs, self._centred, self.hyperparameters)
        return self._mean + (linear + bell) @ self._weights * self._scale

    def state(self) -> dict[str, np.ndarray]:
        """The arguments that make it again, as named arrays."""
        return {
            "inputs": self._inputs,
            "outputs": self._outputs,
            "hyperparameters": self.hyperparameters,
        }


def _start(dimensions: int, noise: float = FIRST_NOISES[0]) -> np.ndarray:
    return np.log([1.0, 1.0, *[FIRST_LENGTH] * dimensions, noise])


def _covariances(
    points: np.ndarray, others: np.ndarray, hyperparameters: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Of points (n, d) with others (m, d): those of the trend and of the smooth function (n, m)."""
    trend, smooth, *lengths, _ = np.exp(hyperparameters)
    linear = trend * (1 + points @ others.T)
    squares = cdist(points / np.array(lengths), others / np.array(lengths), "sqeuclidean")
    return linear, smooth * np.exp(-squares / 2)


def _condition(
    covariances: np.ndarray, outputs: np.ndarray, hyperparameters: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Outputs (n, k) with covariances (n, n), to which those of the noise are added.

    Returns the Cholesky factor, weights (n, k) of the covariances in predictions, and the logarithm
    of the marginal likelihood. Raises LinAlgError: no positive definite matrix.
    """
    count = len(outputs)
    noisy = covariances + np.exp(hyperparameters[-1]) * np.eye(count)
    noisy[np.diag_indices(count)] += JITTER
    factor = cholesky(noisy, lower=True, check_finite=False)
    weights = cho_solve((factor, True), outputs, check_finite=False)
    likelihoods = -np.einsum("ik,ik->k", outputs, weights) / 2 - np.log(np.diag(factor)).sum()
    return factor, weights, float(np.sum(likelihoods - count / 2 * np.log(2 * np.pi)))


def _loss(
    hyperparameters: np.ndarray, inputs: np.ndarray, outputs: np.ndarray
) -> tuple[float, np.ndarray]:
    """The negative logarithm of the marginal likelihood, and its slopes (d + 3,)."""
    linear, bell = _covariances(inputs, inputs, hyperparameters)
    try:
        factor, weights, likelihood = _condition(linear + bell, outputs, hyperparameters)
    except np.linalg.LinAlgError:  # where rounding leaves no factor: a place to leave
        return np.inf, np.zeros_like(hyperparameters)
    _, _, *lengths, noise = np.exp(hyperparameters)
    by_length = bell[..., None] * np.square((inputs[:, None] - inputs) / lengths)
    slopes = np.dstack([linear, bell, by_length, noise * np.eye(len(inputs))])
    inverse = cho_solve((factor, True), np.eye(len(inputs)), check_finite=False)
    inner = np.einsum("ik,jk->ijk", weights, weights) - inverse[..., None]
    return -likelihood, -np.einsum("ijl,jik->kl", inner, slopes).sum(axis=-1) / 2


def _search(inputs: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Hyperparameters of the largest marginal likelihood that searches within the bounds find.

    A bound that is reached (an input that does not matter, no noise) is an answer, not a failure.
    """
    from scipy.optimize import minimize  # a fifth of a second: who predicts need not wait for it

    dimensions = inputs.shape[1]
    bounds = np.log([VARIANCES, VARIANCES, *[LENGTHS] * dimensions, NOISE])
    options = {"jac": True, "bounds": bounds, "options": {"maxiter": STEPS}}
    starts = (_start(dimensions, noise) for noise in FIRST_NOISES)
    found = [minimize(_loss, start, args=(inputs, outputs), **options) for start in starts]
    return min(found, key=lambda result: result.fun).x
