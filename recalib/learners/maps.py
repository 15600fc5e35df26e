"""The hierarchical map: a supernet of positions whose cells each hold a subnet of orientations.

Sections 2 and 3 of the paper. Everything is vectorised over `run`, a training of its own with its
own maps. Axes are named in this order: run, pose, output, coordinate, cell of the supernet (k),
cell of the subnet (l). The last two come last because updates touch every cell, and NumPy is fast
along the last axis.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np
from scipy.linalg.blas import dger

from recalib.nominal.poses import ORIENTATION, POSITION


def regular_grid(shape: Sequence[int]) -> np.ndarray:
    """Centres (cells, d) of the equal boxes into which [-1, 1]^d is cut by shape (d,).

    No other centres have a smaller quantisation error.
    """
    return np.array(list(product(*((2 * np.arange(n) + 1) / n - 1 for n in shape))))


def nearest(points: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Index (...) of the nearest of the centres (cells, d) to each of the points (..., d)."""
    # |p - c|^2 without |p|^2, which is the same for every centre
    return np.argmin((centres**2).sum(axis=1) - 2 * points @ centres.T, axis=-1)


class HierarchicalMap:
    """Maps, one for each run, from desired poses to (part of) the pose commands.

    All in workspace coordinates. They start as the identity, which is right for the intact robot
    (section 3).

    Args:
        runs: how many independent maps.
        supernet, subnet: cells along each position and each orientation coordinate.
        outputs: which coordinates of the command are computed: a slice of the six.

    Attributes:
        w_k (K, 3), w_kl (L, 3): centres of the supernet's cells, and of the cells of each subnet.
        theta: (run, output, K, L) command at each cell's centre.
        jacobian: (run, output, 6, K, L) how the command changes with the desired pose about it.
    """

    def __init__(
        self,
        runs: int,
        supernet: Sequence[int],
        subnet: Sequence[int],
        outputs: slice = slice(0, 6),
    ):
        self.outputs = outputs
        self.w_k, self.w_kl = regular_grid(supernet), regular_grid(subnet)
        cells = (len(self.w_k), len(self.w_kl))
        identity = np.eye(6)[outputs]
        centres = np.empty((6, *cells))
        centres[POSITION], centres[ORIENTATION] = self.w_k.T[:, :, None], self.w_kl.T[:, None, :]
        self.theta = np.tile(centres[outputs], (runs, 1, 1, 1))
        self.jacobian = np.broadcast_to(
            identity[:, :, None, None], (runs, *identity.shape, *cells)
        ).copy()
        self._runs = np.arange(runs)
        self._near_k, self._near_kl = (
            -0.5 * ((w[:, None] - w[None]) ** 2).sum(axis=-1) for w in (self.w_k, self.w_kl)
        )

    def winner(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The winning cells (k, l), each (run, pose), for poses u (run, pose, 6).

        First that of the supernet, then that of its subnet.
        """
        return nearest(u[..., POSITION], self.w_k), nearest(u[..., ORIENTATION], self.w_kl)

    def output(self, u: np.ndarray) -> np.ndarray:
        """Commands (run, pose, output) for poses u (run, pose, 6), equation (1)."""
        k, l = self.winner(u)
        runs = self._runs[:, None]
        offset = u - np.concatenate([self.w_k[k], self.w_kl[l]], axis=-1)
        return self.theta[runs, :, k, l] + np.einsum(
            "rpoi,rpi->rpo", self.jacobian[runs, :, :, k, l], offset
        )

    def at(self, k: np.ndarray, l: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """theta (run, output) and Jacobian (run, output, 6) of one cell (k, l) of each run."""
        return self.theta[self._runs, :, k, l], self.jacobian[self._runs, :, :, k, l]

    def neighbourhood(
        self, k: np.ndarray, l: np.ndarray, width_k: np.ndarray, width_kl: np.ndarray
    ) -> np.ndarray:
        """g_k g_kl (run, K, L) about the winning cells (k, l), each (run,).

        Gaussians of these widths, each (run,).
        """
        g_k = np.exp(self._near_k[k] / np.square(width_k)[:, None])
        g_kl = np.exp(self._near_kl[l] / np.square(width_kl)[:, None])
        return g_k[:, :, None] * g_kl[:, None, :]


def propagate_values(cells: np.ndarray, weights: np.ndarray, values: np.ndarray) -> None:
    """Draw every cell towards one value, in place: (4) and (5).

    Args:
        cells: (run, ..., K, L) theta or Jacobians.
        weights: (run, K, L) learning rate times neighbourhood.
        values: (run, ...) theta* or A*; a run whose weights are zero learns nothing.
    """
    for cell, weight, value in zip(cells, weights, values, strict=True):
        cell *= 1 - weight
        _add_product(cell, value, weight)


def propagate_increments(cells: np.ndarray, weights: np.ndarray, increments: np.ndarray) -> None:
    """Move every cell by one increment, in place: (7) and (9). Arguments as `propagate_values`."""
    for cell, weight, increment in zip(cells, weights, increments, strict=True):
        _add_product(cell, increment, weight)


def _add_product(cells: np.ndarray, values: np.ndarray, weights: np.ndarray) -> None:
    """Add values (...) times weights (K, L) to cells (..., K, L) of one run, in place.

    By BLAS, in one pass: NumPy would make the product first, and it is as large as all the cells.
    """
    table = cells.reshape(-1, weights.size)  # a view: a run's cells lie together
    dger(1.0, weights.ravel(), values.ravel(), a=table.T, overwrite_a=True)
