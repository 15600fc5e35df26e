"""The learners of the paper: hierarchical maps with Ritter's rules or the improved ones.

The improvement of the paper is four changes of Ritter's algorithm. Each is a switch of its own
here, so that any of them can be taken away from the one or added to the other.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from recalib.errors import InvalidSetting
from recalib.interfaces import Execute, State
from recalib.learners import schedules
from recalib.learners.maps import HierarchicalMap, propagate_increments, propagate_values
from recalib.nominal.poses import ORIENTATION, POSITION

SEPARATE = {"position": POSITION, "orientation": ORIENTATION}
SINGLE = {"pose": slice(0, 6)}

# Below this length of a move, in workspace coordinates, (3) and (8) would divide rounding errors by
# rounding errors.
SHORTEST_MOVE = 1e-6


@dataclass(frozen=True)
class Rules:
    """The four switches and the sizes of the nets.

    Args:
        separate_maps: one map for position and one for orientation commands (section 4), or one
            for both.
        theta_increments: propagate increments of theta, (6) and (7), or its values, (2) and (4).
        jacobian_increments: propagate increments of the Jacobian, (8) and (9), or its values, (3)
            and (5).
        equal_visits: the schedule of section 6 with a linear rate, or Ritter's exponential
            schedules.
        supernet, subnet: cells along each position and each orientation coordinate.
    """

    separate_maps: bool
    theta_increments: bool
    jacobian_increments: bool
    equal_visits: bool
    supernet: tuple[int, int, int] = (3, 3, 3)
    subnet: tuple[int, int, int] = (3, 3, 3)

    @property
    def maps(self) -> Mapping[str, slice]:
        """Name of each map and the coordinates of the command that it computes."""
        return SEPARATE if self.separate_maps else SINGLE


IMPROVED = Rules(
    separate_maps=True, theta_increments=True, jacobian_increments=True, equal_visits=True
)


@dataclass(frozen=True)
class Schedule:
    """Widths and rates at the start and at the end of training, each a number or an array (run,).

    Args:
        initial_width: of all neighbourhoods (section 7), in workspace coordinates: the workspace
            is 2 wide.
        final_widths: for each map (`Rules.maps`), those of g_k and of g_kl.
        initial_rate, final_rate: the learning rate c' of (4), (5), (7) and (9).

    Raises InvalidSetting where a width is not above 0 or a rate not in (0, 1].
    """

    initial_width: float | np.ndarray
    final_widths: Mapping[str, tuple[float | np.ndarray, float | np.ndarray]]
    initial_rate: float | np.ndarray
    final_rate: float | np.ndarray

    def __post_init__(self):
        for width in self.widths:
            if not np.all(np.greater(width, 0)):
                raise InvalidSetting("width of a neighbourhood", width, "above 0")
        for rate in self.rates:
            if not np.all(np.greater(rate, 0) & np.less_equal(rate, 1)):
                raise InvalidSetting("learning rate", rate, "above 0 and at most 1")

    @property
    def widths(self) -> list[float | np.ndarray]:
        """All of them, the initial one first."""
        return [
            self.initial_width,
            *(width for pair in self.final_widths.values() for width in pair),
        ]

    @property
    def rates(self) -> list[float | np.ndarray]:
        """Both of them, the initial one first."""
        return [self.initial_rate, self.final_rate]


class HierarchicalLearner:
    """Hierarchical maps that learn by the cycle of section 2, but for its first step.

    The centres of the cells stay where they are (section 3).

    Args:
        runs: how many independent trainings.
        rules: which rules to learn by.
        schedule: how widths and rates fall.
    """

    kind = "hierarchical"

    def __init__(self, runs: int, rules: Rules, schedule: Schedule):
        self.rules, self.schedule = rules, schedule
        self.maps = {
            name: HierarchicalMap(runs, rules.supernet, rules.subnet, outputs)
            for name, outputs in rules.maps.items()
        }

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6), by (1)."""
        return np.concatenate([each.output(desired) for each in self.maps.values()], axis=-1)

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One learning cycle with its two moves; see `Learner.learn`.

        Nothing is learned from a refused move.
        """
        cells = {
            name: (k[:, 0], l[:, 0])
            for name, each in self.maps.items()
            for k, l in [each.winner(desired[:, None])]
        }
        winners = {name: each.at(*cells[name]) for name, each in self.maps.items()}
        theta = self.command(desired[:, None])
        first = execute(theta)
        miss = desired - first.achieved[:, 0]  # u - u'
        # A_kl (u - u'): the correction of the second movement, and the increment of (6)
        correction = {
            name: np.einsum("roi,ri->ro", jacobian, miss) for name, (_, jacobian) in winners.items()
        }
        second = execute(theta + np.concatenate(list(correction.values()), axis=-1)[:, None])
        moved = second.achieved[:, 0] - first.achieved[:, 0]  # u'' - u'
        length = np.square(moved).sum(axis=-1)
        learn_theta = first.executed[:, 0]
        learn_jacobian = learn_theta & second.executed[:, 0] & (length > SHORTEST_MOVE**2)
        direction = moved / np.where(learn_jacobian, length, 1)[:, None]
        for name, each in self.maps.items():
            theta_kl, jacobian_kl = winners[name]
            weights = self._weights(name, *cells[name], fraction)
            # Both rules start from the same increments, (6) and (8); Ritter's targets add what the
            # winner held, (2) and (3).
            theta_step = correction[name]
            jacobian_step = (theta_step - np.einsum("roi,ri->ro", jacobian_kl, moved))[
                :, :, None
            ] * direction[:, None, :]
            theta_weights, jacobian_weights = (
                weights * learn[:, None, None] for learn in (learn_theta, learn_jacobian)
            )
            if self.rules.theta_increments:
                propagate_increments(each.theta, theta_weights, theta_step)
            else:
                propagate_values(each.theta, theta_weights, theta_kl + theta_step)
            if self.rules.jacobian_increments:
                propagate_increments(each.jacobian, jacobian_weights, jacobian_step)
            else:
                propagate_values(each.jacobian, jacobian_weights, jacobian_kl + jacobian_step)

    def widths(self, name: str, fraction: float) -> tuple[np.ndarray, np.ndarray]:
        """Widths of g_k and of g_kl, each (run,), after this fraction of the training.

        Args:
            name: of a map; see `Rules.maps`.
        """
        plan, runs = self.schedule, len(self.maps[name].theta)
        narrow = schedules.equal_visits if self.rules.equal_visits else schedules.exponential
        of_k, of_kl = (
            np.broadcast_to(narrow(plan.initial_width, end, fraction), runs)
            for end in plan.final_widths[name]
        )
        return of_k, of_kl

    def settings(self) -> dict[str, Any]:
        """Rules and schedule.

        Raises InvalidSetting where the runs differ in their schedule: they are trials of a search.
        """
        if any(np.ndim(value) for value in (*self.schedule.widths, *self.schedule.rates)):
            raise InvalidSetting("schedule", self.schedule, "one that all runs share")
        return {"rules": asdict(self.rules), "schedule": asdict(self.schedule)}

    def state(self) -> list[State]:
        """For each run theta and Jacobian of each map, as `HierarchicalMap` describes them."""
        runs = range(len(next(iter(self.maps.values())).theta))
        return [
            {
                name: {"theta": each.theta[run], "jacobian": each.jacobian[run]}
                for name, each in self.maps.items()
            }
            for run in runs
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        for run, state in enumerate(states):
            for name, each in self.maps.items():
                each.theta[run] = state[name]["theta"]
                each.jacobian[run] = state[name]["jacobian"]

    def _weights(self, name: str, k: np.ndarray, l: np.ndarray, fraction: float) -> np.ndarray:
        """c' g_k g_kl (run, K, L)."""
        plan = self.schedule
        weaken = schedules.linear if self.rules.equal_visits else schedules.exponential
        rate = np.broadcast_to(weaken(plan.initial_rate, plan.final_rate, fraction), k.shape)
        widths = self.widths(name, fraction)
        return rate[:, None, None] * self.maps[name].neighbourhood(k, l, *widths)
