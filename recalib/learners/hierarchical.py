"""The learners of the paper: hierarchical maps with Ritter's rules or the improved ones."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from recalib.errors import InvalidSetting
from recalib.interfaces import Execute, State
from recalib.learners import schedules
from recalib.learners.maps import HierarchicalMap, Nets
from recalib.learners.rules import Rules

# Below this length of a move, in workspace coordinates, (3) and (8) would divide rounding errors by
# rounding errors.
SHORTEST_MOVE = 1e-6


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
        self.nets = Nets(rules.supernet, rules.subnet)
        self.maps = {
            name: HierarchicalMap(runs, self.nets, rules, outputs)
            for name, outputs in rules.maps.items()
        }
        self._runs = np.arange(runs)
        self._final_widths = {
            name: np.stack([np.broadcast_to(width, runs) for width in pair])
            for name, pair in schedule.final_widths.items()
        }

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        k, l = self.nets.winner(desired)
        cells = self._runs[:, None], k, l
        maps = self.maps.values()
        theta = np.concatenate([each.theta.all[cells] for each in maps], axis=-1)
        jacobian = np.concatenate([each.jacobian.all[cells] for each in maps], axis=-2)
        return theta + applied(jacobian, desired - self.nets.centres[k, l])  # (1)

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One learning cycle with its two moves; see `Learner.learn`.

        Nothing is learned from a refused move.
        """
        k, l = self.nets.winner(desired)
        maps = self.maps.values()
        theta = np.concatenate([each.theta.at(k, l) for each in maps], axis=-1)
        jacobian = np.concatenate([each.jacobian.at(k, l) for each in maps], axis=-2)
        command = theta + applied(jacobian, desired - self.nets.centres[k, l])  # (1)
        first = execute(command[:, None])
        # A_kl (u - u'): the correction of the second movement, and the increment of (6)
        correction = applied(jacobian, desired - first.achieved[:, 0])
        second = execute((command + correction)[:, None])
        moved = second.achieved[:, 0] - first.achieved[:, 0]  # u'' - u'
        length = np.square(moved).sum(axis=-1)
        learn_theta = first.executed[:, 0]
        learn_jacobian = learn_theta & second.executed[:, 0] & (length > SHORTEST_MOVE**2)
        direction = moved / np.where(learn_jacobian, length, 1)[:, None]
        # Both rules start from the same increments, (6) and (8); Ritter's targets add what the
        # winner held, (2) and (3).
        new_theta = correction
        new_jacobian = (correction - applied(jacobian, moved))[:, :, None] * direction[:, None, :]
        if not self.rules.theta_increments:
            new_theta = theta + new_theta
        if not self.rules.jacobian_increments:
            new_jacobian = jacobian + new_jacobian
        rate = self._rate(fraction)
        for name, each in self.maps.items():
            near = self.nets.neighbourhood(k, l, *self.widths(name, fraction))
            each.theta.update(rate * learn_theta, *near, new_theta[:, each.outputs])
            each.jacobian.update(rate * learn_jacobian, *near, new_jacobian[:, each.outputs])

    def widths(self, name: str, fraction: float) -> np.ndarray:
        """Widths (2, run) of g_k and of g_kl after this fraction of the training.

        Args:
            name: of a map; see `Rules.maps`.
        """
        narrow = schedules.equal_visits if self.rules.equal_visits else schedules.exponential
        return narrow(self.schedule.initial_width, self._final_widths[name], fraction)

    def settings(self) -> dict[str, Any]:
        """Rules and schedule.

        Raises InvalidSetting where the runs differ in their schedule: they are trials of a search.
        """
        if any(np.ndim(value) for value in (*self.schedule.widths, *self.schedule.rates)):
            raise InvalidSetting("schedule", self.schedule, "one that all runs share")
        return {"rules": asdict(self.rules), "schedule": asdict(self.schedule)}

    def state(self) -> list[State]:
        """For each run theta and Jacobian of each map, as `HierarchicalMap` describes them."""
        return [
            {
                name: {"theta": each.theta.all[run], "jacobian": each.jacobian.all[run]}
                for name, each in self.maps.items()
            }
            for run in self._runs
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        for name, each in self.maps.items():
            each.theta.all[:] = [state[name]["theta"] for state in states]
            each.jacobian.all[:] = [state[name]["jacobian"] for state in states]

    def _rate(self, fraction: float) -> float | np.ndarray:
        """c', a number or (run,)."""
        weaken = schedules.linear if self.rules.equal_visits else schedules.exponential
        return weaken(*self.schedule.rates, fraction)


def applied(jacobian: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """A d (..., 6) of Jacobians A (..., 6, 6) and offsets d (..., 6)."""
    return np.einsum("...oi,...i->...o", jacobian, offset)
