"""The covariance of `regression`: a linear trend, a smooth function and white noise."""

import numpy as np
from scipy.spatial.distance import cdist
from sklearn.gaussian_process.kernels import Kernel


class Covariance(Kernel):  # type: ignore[misc]  # scikit-learn has no types
    """The covariance as one kernel: faster than a sum of scikit-learn's.

    Args:
        theta: (d + 3,) the hyperparameters.
    """

    theta = np.empty(0)  # replaces a property that collects them from the parts of a kernel

    def __init__(self, theta: np.ndarray):
        self.theta = theta

    def __call__(
        self, X: np.ndarray, Y: np.ndarray | None = None, eval_gradient: bool = False
    ) -> np.ndarray | tuple[np.ndarray, np.ndarray]:
        """Covariances (n, m) of points X (n, d) with points Y (m, d), or of X with itself.

        The latter include the noise; `eval_gradient` adds their gradient (n, n, d + 3) by the
        hyperparameters.
        """
        sizes = np.exp(self.theta)
        trend, smooth, lengths, noise = sizes[0], sizes[1], sizes[2:-1], sizes[-1]
        others = X if Y is None else Y
        linear = trend * (1 + X @ others.T)
        squares = cdist(X / lengths, others / lengths, "sqeuclidean")
        bell = smooth * np.exp(-squares / 2)
        if Y is not None:
            return linear + bell
        white = noise * np.eye(len(X))
        covariances = linear + bell + white
        if not eval_gradient:
            return covariances
        by_length = bell[..., None] * np.square((X[:, None] - X) / lengths)
        return covariances, np.dstack([linear, bell, by_length, white])

    def diag(self, X: np.ndarray) -> np.ndarray:
        """Variances (n,) at the points X (n, d)."""
        return np.diag(self(X))

    def is_stationary(self) -> bool:
        """It is not: the trend has a centre."""
        return False
