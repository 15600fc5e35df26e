"""The hierarchical maps of a learner, and the updates of their cells that wait to be applied."""

import numpy as np

from recalib.learners import kernels
from recalib.learners.kernels import JACOBIAN, THETA, WAITING, Cells
from recalib.learners.nets import Nets
from recalib.learners.rules import Rules


class Maps:
    """The maps of a learner in each run, from desired poses to (part of) the pose commands.

    They start as the identity, which is right for the intact robot (section 3). Values of theta may
    start at random, as Ritter's do: new values replace them. Increments of theta never replace
    their start, nor does anything where the Jacobian is random or zero: both start as the identity.

    What one run learns depends on no other run.

    Args:
        runs: how many independent trainings.
        rules: to learn by.

    Attributes:
        nets: where the cells are, the same in all maps.
        cells: what they hold, of `recalib.learners.kernels.Cells`.
        waiting: how many updates of them wait.
        increments: whether increments of theta and of Jacobians are propagated, or their values.
    """

    def __init__(self, runs: int, rules: Rules):
        self.nets = nets = Nets(rules.supernet, rules.subnet, rules.centres, rules.width_units)
        shape, maps = nets.centres.shape[:2], len(rules.maps)
        theta = nets.centres
        if rules.initial is not None and not rules.theta_increments:
            theta = np.random.default_rng(rules.initial).uniform(-1, 1, theta.shape)
        jacobian = np.broadcast_to(np.eye(6).ravel(), (*shape, 36))
        # In C order, which `np.stack` does not choose for copies of one Jacobian: `settle` takes
        # twice as long in any other.
        theta, jacobian = (
            np.ascontiguousarray(np.stack([np.stack(np.split(start, maps, axis=-1))] * runs))
            for start in (theta, jacobian)
        )
        waiting = runs, maps, WAITING
        self.cells = Cells(
            w_k=nets.w_k,
            w_kl=nets.w_kl,
            squares_k=nets.squares_k,
            squares_kl=nets.squares_kl,
            theta=theta,
            jacobian=jacobian,
            g_k=np.zeros((*waiting, shape[0])),
            g_kl=np.zeros((*waiting, shape[1])),
            theta_star=np.zeros((*waiting, 6 // maps)),
            jacobian_star=np.zeros((*waiting, 36 // maps)),
            rates=np.zeros((runs, WAITING, 2)),
        )
        self.waiting = 0
        self.increments = rules.theta_increments, rules.jacobian_increments

    def settle(self) -> None:
        """Apply the updates that wait, run by run: so the cache holds what a run needs."""
        waiting, self.waiting, cells = slice(self.waiting), 0, self.cells
        if not waiting.stop:
            return
        for run, each in np.ndindex(cells.theta.shape[:2]):
            here, rates = (run, each, waiting), cells.rates[run, waiting]
            g_k, g_kl = cells.g_k[here], cells.g_kl[here]
            theta, jacobian = cells.theta[run, each], cells.jacobian[run, each]
            star = cells.theta_star[here]
            _apply(theta, rates[:, THETA], g_k, g_kl, star, self.increments[THETA])
            star = cells.jacobian_star[here]
            _apply(jacobian, rates[:, JACOBIAN], g_k, g_kl, star, self.increments[JACOBIAN])


def _apply(
    held: np.ndarray,
    rate: np.ndarray,
    g_k: np.ndarray,
    g_kl: np.ndarray,
    star: np.ndarray,
    increments: bool,
) -> None:
    """Move cells (K, L, n) by updates, (7) and (9), or draw them towards them, (4) and (5)."""
    if increments:
        weighted = rate[:, None] * g_k
        held += (weighted.T @ kernels.spread_over(g_kl, star)).reshape(held.shape)
    else:
        weights, remaining = kernels.lasting(rate, g_k, g_kl)
        kernels.draw(held, remaining, weights.T @ star)
