"""The hierarchical map: a supernet of positions whose cells each hold a subnet of orientations.

Sections 2 and 3 of the paper. Everything is vectorised over `run`, a training of its own with its
own maps. Axes are named in this order: run, pose, cell of the supernet (k), cell of the subnet (l),
output, coordinate.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from recalib.learners.cells import Cells
from recalib.learners.rules import Rules
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


class Nets:
    """Where the cells of a hierarchical map are, in workspace coordinates.

    Args:
        supernet, subnet: cells along each position and each orientation coordinate.

    Attributes:
        w_k (K, 3), w_kl (L, 3): centres of the supernet's cells, and of the cells of each subnet.
        centres: (K, L, 6) both, as poses.
    """

    def __init__(self, supernet: Sequence[int], subnet: Sequence[int]):
        self.w_k, self.w_kl = regular_grid(supernet), regular_grid(subnet)
        k, l = np.indices((len(self.w_k), len(self.w_kl)))
        self.centres = np.concatenate([self.w_k[k], self.w_kl[l]], axis=-1)
        self._near_k, self._near_kl = (
            -0.5 * ((w[:, None] - w[None]) ** 2).sum(axis=-1) for w in (self.w_k, self.w_kl)
        )

    def winner(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The winning cells (k, l), each (...), for poses u (..., 6).

        First that of the supernet, then that of its subnet.
        """
        return nearest(u[..., POSITION], self.w_k), nearest(u[..., ORIENTATION], self.w_kl)

    def neighbourhood(
        self, k: np.ndarray, l: np.ndarray, width_k: np.ndarray, width_kl: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """g_k (run, K) and g_kl (run, L) about the winning cells (k, l), each (run,).

        Gaussians of these widths, each (run,).
        """
        return (
            np.exp(self._near_k[k] / np.square(width_k)[:, None]),
            np.exp(self._near_kl[l] / np.square(width_kl)[:, None]),
        )


class HierarchicalMap:
    """Maps, one for each run, from desired poses to (part of) the pose commands.

    They start as the identity, which is right for the intact robot (section 3).

    Args:
        runs: how many independent maps.
        nets: where their cells are.
        rules: to learn by.
        outputs: which coordinates of the command are computed: a slice of the six.

    Attributes:
        theta: `Cells` (run, K, L, output), the command at each centre.
        jacobian: `Cells` (run, K, L, output, 6), how it changes with the desired pose about it.
    """

    def __init__(self, runs: int, nets: Nets, rules: Rules, outputs: slice = slice(0, 6)):
        self.outputs = outputs
        self.theta = Cells(runs, nets.centres[..., outputs], rules.theta_increments)
        identity = np.broadcast_to(np.eye(6), (*nets.centres.shape, 6))
        self.jacobian = Cells(runs, identity[..., outputs, :], rules.jacobian_increments)
