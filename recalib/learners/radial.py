"""The paper's rules for another kind of local unit: normalised Gaussian radial units.

"Other neural network algorithms based on local units can also benefit from these improvements"
(section 8). A unit holds a command and no Jacobian: this is the simplest kind.
"""

import numpy as np
from scipy.special import softmax

from recalib.arrays import array_of
from recalib.errors import InvalidSetting, check_function, check_kind
from recalib.learners import cell_loops
from recalib.learners.nets import Nets
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule, fall
from recalib.loop.interfaces import Execute
from recalib.loop.moves import check_moves
from recalib.nominal.workspace import ORIENTATION, POSITION

SPACING = 2 / 3  # the distance of cells, if three lie along a coordinate of the workspace, 2 wide


class RadialLearner:
    """Units i with commands theta_i at centres w_i; the output blends their corrections.

    For a desired pose u the command is

        u + sum_i phi_i(u) (theta_i - w_i) / sum_i phi_i(u),
        phi_i(u) = exp(-|u - w_i|^2 / (2 s^2)),

    which is u before learning. An iteration is one move, which achieves u'. Its error e = u - u'
    is the increment in (6), with the identity as Jacobian. The winner is the unit whose centre is
    nearest to u. With the neighbourhoods g of section 2 about it, every unit learns by (7) or (4),

        theta_i += c' g_i e    or    theta_i += c' g_i (theta_winner + e - theta_i).

    Args:
        rules: the paper's rules: sizes and centres of the nets, whose pairs of cells (k, l) are the
            units; one map or two (section 4); increments of theta or values (section 5); and the
            law of widths and rates (section 6). Rules for Jacobians have no effect here.
        schedule: the fall of widths and rates.
        field: s, the constant width of the receptive fields, in workspace coordinates.
        runs: number of independent trainings.

    Attributes:
        theta: (run, K, L, 6) commands that the units hold.

    Raises InvalidSetting like `HierarchicalLearner`, and if the field is not above 0.
    """

    def __init__(self, rules: Rules, schedule: Schedule, field: float = SPACING, *, runs: int = 1):
        check_kind("rules", rules, Rules)
        check_kind("schedule", schedule, Schedule)
        if not array_of("field", field, ()) > 0:
            raise InvalidSetting("field", field, "above 0")
        self.rules, self.schedule = rules, schedule.over(runs)
        self.nets = Nets(rules.supernet, rules.subnet, rules.centres, rules.width_units)
        self._widths = self.schedule.widths(rules.maps)
        self.theta = np.tile(self.nets.centres, (runs, 1, 1, 1))
        self._field = field

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6).

        Raises InvalidSetting for another shape, or NaN.
        """
        desired = array_of("desired", desired, (len(self.theta), "n", 6))
        # phi is a product of one Gaussian in each net, so its sum over all units factors likewise
        phi_k = self._shares(desired[..., POSITION], self.nets.w_k)
        phi_kl = self._shares(desired[..., ORIENTATION], self.nets.w_kl)
        corrections = self.theta - self.nets.centres  # (run, K, L, 6)
        runs, supernet = corrections.shape[:2]
        by_subnet = (phi_k @ corrections.reshape(runs, supernet, -1)).reshape(
            *phi_kl.shape, corrections.shape[-1]
        )
        return desired + (phi_kl[..., None, :] @ by_subnet)[..., 0, :]

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """Make one move and update all units; see `Learner.learn`.

        A refused move changes nothing. Raises BadMeasurement if the achieved pose is not a number,
        or far off.
        """
        desired = array_of("desired", desired, (len(self.theta), 6))
        array_of("fraction", fraction, ())
        check_function("execute", execute)
        command = self.command(desired[:, None])
        outcome = execute(command)
        check_moves(command, outcome.achieved, outcome.executed)
        increment = desired - outcome.achieved[:, 0]  # e
        start, end = np.asarray(self.schedule.initial_rate), np.asarray(self.schedule.final_rate)
        rate = fall(start, end, fraction, self.rules.rate_power) * outcome.executed[:, 0]
        k, l = self.nets.winner(desired)
        winner = self.theta[np.arange(len(k)), k, l]
        widths = fall(*self._widths, fraction, self.rules.width_power)
        for map_, outputs in enumerate(self.rules.maps.values()):
            g_k, g_kl = self.nets.neighbourhood(k, l, *widths[:, map_].T)
            star = increment[:, outputs]
            if not self.rules.theta_increments:
                star = winner[:, outputs] + star
            theta = self.theta[..., outputs]
            cell_loops.propagate(
                theta, rate[:, None] * g_k, g_kl, star, self.rules.theta_increments
            )

    def _shares(self, points: np.ndarray, centres: np.ndarray) -> np.ndarray:
        """phi divided by its sum (run, pose, cell), in one net, for points (run, pose, 3)."""
        squares = np.square(points[..., None, :] - centres).sum(axis=-1)
        return softmax(-squares / (2 * self._field**2), axis=-1)
