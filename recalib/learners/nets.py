"""The cells of a hierarchical map: a supernet of positions, and subnets of orientations.

See sections 2 and 3 of the paper. Everything is in workspace coordinates.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from recalib.learners import cell_loops
from recalib.nominal.workspace import ORIENTATION, POSITION

# "A regular grid covering" the workspace (section 3): along each coordinate in [-1, 1], the middles
# of n equal boxes, which minimise the quantisation error, or n points from face to face.
CENTRES = {
    "boxes": lambda n: (2 * np.arange(n) + 1) / n - 1,
    "faces": lambda n: np.linspace(-1, 1, n) if n > 1 else np.zeros(1),
}


def regular_grid(shape: Sequence[int], centres: str = "boxes") -> np.ndarray:
    """Centres (cells, d) of cells in [-1, 1]^d; `shape` (d,) is the number along each coordinate.

    Args:
        centres: one of `CENTRES`.
    """
    return np.array(list(product(*map(CENTRES[centres], shape))))


def nearest(points: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Index (...) of the nearest of the centres (cells, d) to each of the points (..., d)."""
    found = cell_loops.nearest_of(points.reshape(-1, points.shape[-1]), centres)
    return found.reshape(points.shape[:-1])


class Nets:
    """A supernet whose cells k each hold a subnet of cells l.

    Args:
        supernet, subnet: cells along each position and each orientation coordinate.
        centres: one of `CENTRES`.
        units: six factors that turn workspace coordinates into the units of widths.

    Attributes:
        w_k (K, 3), w_kl (L, 3): centres of the supernet's cells, and of the cells of each subnet.
        centres: (K, L, 6) the centres of both, as poses.
        squares_k (K, K), squares_kl (L, L): squared distances between centres, in units of widths.
    """

    def __init__(
        self, supernet: Sequence[int], subnet: Sequence[int], centres: str, units: Sequence[float]
    ):
        self.w_k, self.w_kl = regular_grid(supernet, centres), regular_grid(subnet, centres)
        k, l = np.indices((len(self.w_k), len(self.w_kl)))
        self.centres = np.concatenate([self.w_k[k], self.w_kl[l]], axis=-1)
        self.squares_k, self.squares_kl = (
            (((w[:, None] - w[None]) * units[part]) ** 2).sum(axis=-1)
            for w, part in ((self.w_k, POSITION), (self.w_kl, ORIENTATION))
        )

    def winner(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The winning cells (k, l), each (...), for poses u (..., 6).

        k is a cell of the supernet, l a cell of its subnet.
        """
        return nearest(u[..., POSITION], self.w_k), nearest(u[..., ORIENTATION], self.w_kl)

    def neighbourhood(
        self, k: np.ndarray, l: np.ndarray, width_k: np.ndarray, width_kl: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """g_k (run, K) and g_kl (run, L) about the winning cells (k, l), each (run,).

        Both are Gaussians. Their widths, each (run,), are in units of widths.
        """
        return (
            np.exp(-self.squares_k[k] / (2 * np.square(width_k)[:, None])),
            np.exp(-self.squares_kl[l] / (2 * np.square(width_kl)[:, None])),
        )
