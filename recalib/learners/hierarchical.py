"""The learners of the paper: hierarchical maps with Ritter's rules or the improved ones."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from recalib.learners.maps import HierarchicalMap
from recalib.learners.nets import Nets
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule
from recalib.loop.interfaces import Execute, State
from recalib.loop.measurements import check_moves

if TYPE_CHECKING:
    from recalib.nominal.robots import Robot

# Below this length of a move, in workspace coordinates, (3) and (8) would divide rounding errors by
# rounding errors.
SHORTEST_MOVE = 1e-6


class HierarchicalLearner:
    """Hierarchical maps that learn by the cycle of section 2, but for its first step.

    The centres of the cells stay where they are (section 3).

    Args:
        rules: which rules to learn by.
        schedule: how widths and rates fall.
        runs: how many independent trainings.
    """

    def __init__(self, rules: Rules, schedule: Schedule, *, runs: int = 1):
        self.rules, self.schedule = rules, schedule.over(runs)
        self.nets = Nets(rules.supernet, rules.subnet, rules.centres, rules.width_units)
        self.maps = {
            name: HierarchicalMap(runs, self.nets, rules, outputs)
            for name, outputs in rules.maps.items()
        }
        self._runs = np.arange(runs)

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        k, l = self.nets.winner(desired)
        cells = self._runs[:, None], k, l
        maps = self.maps.values()
        theta = np.concatenate([net.theta.all[cells] for net in maps], axis=-1)
        jacobian = np.concatenate([net.jacobian.all[cells] for net in maps], axis=-2)
        return theta + applied(jacobian, desired - self.nets.centres[k, l])  # (1)

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One learning cycle with its two moves; see `Learner.learn`.

        Nothing is learned from a refused move. Raises BadMeasurement where what is achieved is no
        number, far off, or the same whatever is sent.
        """
        k, l = self.nets.winner(desired)
        maps = self.maps.values()
        theta = np.concatenate([net.theta.at(k, l) for net in maps], axis=-1)
        jacobian = np.concatenate([net.jacobian.at(k, l) for net in maps], axis=-2)
        command = theta + applied(jacobian, desired - self.nets.centres[k, l])  # (1)
        first = execute(command[:, None])
        last = check_moves(command[:, None], first.achieved, first.executed)
        # A_kl (u - u'): the correction of the second movement, and the increment of (6)
        correction = applied(jacobian, desired - first.achieved[:, 0])
        corrected = (command + correction)[:, None]
        second = execute(corrected)
        check_moves(corrected, second.achieved, second.executed, last)
        moved = second.achieved[:, 0] - first.achieved[:, 0]  # u'' - u'
        learn_theta = first.executed[:, 0]
        far = np.square(moved).sum(axis=-1) > SHORTEST_MOVE**2
        learn_jacobian = learn_theta & second.executed[:, 0] & far
        # du^T / |du|^2 in the units of the metric; the Jacobian's columns are back in coordinates.
        direction = np.square(self.rules.metric) * moved
        length = (direction * moved).sum(axis=-1)
        direction /= np.where(learn_jacobian, length, 1)[:, None]
        # Both rules start from the same increments, (6) and (8); Ritter's targets add what the
        # winner held, (2) and (3).
        new_theta = correction
        new_jacobian = (correction - applied(jacobian, moved))[:, :, None] * direction[:, None, :]
        if not self.rules.theta_increments:
            new_theta = theta + new_theta
        if not self.rules.jacobian_increments:
            new_jacobian = jacobian + new_jacobian
        rate = self.rules.learning_rate(self.schedule, fraction)
        for name, net in self.maps.items():
            widths = self.rules.widths(self.schedule, name, fraction)
            neighbourhood = self.nets.neighbourhood(k, l, *widths)
            net.theta.update(rate * learn_theta, *neighbourhood, new_theta[:, net.outputs])
            net.jacobian.update(rate * learn_jacobian, *neighbourhood, new_jacobian[:, net.outputs])

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: "Robot") -> Self:
        """The learner of so many runs that has learned nothing, from what `settings` returned."""
        rules: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value
            for name, value in settings["rules"].items()
        }
        schedule = Schedule.of_runs([Schedule(**its) for its in settings["by_run"]])
        return cls(Rules(**rules), schedule, runs=runs)

    def settings(self) -> dict[str, Any]:
        """The rules and, by run, the schedule."""
        by_run = [asdict(self.schedule.of_run(run)) for run in range(len(self._runs))]
        return {"rules": asdict(self.rules), "by_run": by_run}

    def state(self) -> list[State]:
        """For each run theta and Jacobian of each map, as `HierarchicalMap` describes them."""
        return [
            {
                name: {"theta": net.theta.all[run].copy(), "jacobian": net.jacobian.all[run].copy()}
                for name, net in self.maps.items()
            }
            for run in self._runs
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        for name, net in self.maps.items():
            net.theta.all[:] = [state[name]["theta"] for state in states]
            net.jacobian.all[:] = [state[name]["jacobian"] for state in states]


def applied(jacobian: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """A d (..., 6) of Jacobians A (..., 6, 6) and offsets d (..., 6)."""
    return np.einsum("...oi,...i->...o", jacobian, offset)
