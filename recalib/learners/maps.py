"""The hierarchical map: what the cells of a supernet and its subnets hold, for (1).

Everything is vectorised over `run`. Axes are named in this order: run, pose, cell of the supernet
(k), cell of the subnet (l), output, coordinate.
"""

import numpy as np

from recalib.learners.cells import Cells
from recalib.learners.nets import Nets
from recalib.learners.rules import Rules


class HierarchicalMap:
    """Maps, one for each run, from desired poses to (part of) the pose commands.

    They start as the identity, which is right for the intact robot (section 3). Values of theta may
    start at random, as Ritter's do: new values replace them. Increments of theta never replace
    their start, nor does anything where the Jacobian is random or zero: both start as the identity.

    Args:
        runs: how many independent maps.
        nets: where their cells are.
        rules: to learn by.
        outputs: which coordinates of the command are computed: a slice of the six.

    Attributes:
        theta: `Cells` (run, K, L, output), the command at each centre.
        jacobian: `Cells` (run, K, L, output, 6), how it changes with the desired pose about it.
    """

    def __init__(self, runs: int, nets: Nets, rules: Rules, outputs: slice):
        self.outputs = outputs
        start = nets.centres
        if rules.initial is not None and not rules.theta_increments:
            start = np.random.default_rng(rules.initial).uniform(-1, 1, start.shape)
        self.theta = Cells(runs, start[..., outputs], rules.theta_increments)
        identity = np.broadcast_to(np.eye(6), (*nets.centres.shape, 6))
        self.jacobian = Cells(runs, identity[..., outputs, :], rules.jacobian_increments)
