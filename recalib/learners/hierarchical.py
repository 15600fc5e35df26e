"""The learners of the paper: hierarchical maps with Ritter's rules or the improved ones."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any, Self

import numpy as np

from recalib.arrays import array_of
from recalib.errors import check_kind
from recalib.learners import kernels
from recalib.learners.maps import Maps
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule, fall
from recalib.loop.interfaces import Execute, State
from recalib.loop.moves import check_moves
from recalib.nominal.robots import Robot


class HierarchicalLearner:
    """Hierarchical maps with the learning cycle of section 2, without its first step.

    The centres of the cells stay where they are (section 3).

    Args:
        rules: which rules to learn by.
        schedule: how widths and rates fall.
        runs: how many independent trainings.

    Raises InvalidSetting where the schedule is for other maps than the rules, or for other runs.
    """

    def __init__(self, rules: Rules, schedule: Schedule, *, runs: int = 1):
        check_kind("rules", rules, Rules)
        check_kind("schedule", schedule, Schedule)
        self.rules, self.schedule = rules, schedule.over(runs)
        self.maps = Maps(runs, rules)
        self._runs = runs
        self._metric = np.square(np.asarray(rules.metric, dtype=float))
        self._widths = *self.schedule.widths(rules.maps), rules.width_power
        start, end = np.asarray(self.schedule.initial_rate), np.asarray(self.schedule.final_rate)
        self._rate = start, end, rules.rate_power

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6).

        Raises InvalidSetting: another shape, NaN.
        """
        desired = array_of("desired", desired, (self._runs, "n", 6))
        self.maps.settle()
        return kernels.commands(tuple(self.maps.cells), np.ascontiguousarray(desired))

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One learning cycle with its two moves; see `Learner.learn`.

        Nothing is learned from a refused move. Raises BadMeasurement if the achieved pose
        is not a number, far off, or the same for all commands.
        """
        maps, desired = self.maps, np.ascontiguousarray(desired)
        if maps.waiting == kernels.WAITING:
            maps.settle()
        cells = tuple(maps.cells), maps.waiting, maps.increments
        command, winners, theta, jacobian = kernels.respond(*cells, desired)
        sent = command[:, None]
        first = execute(sent)
        last = check_moves(sent, first.achieved, first.executed)
        correction = kernels.corrections(jacobian, desired, first.achieved)
        sent = (command + correction)[:, None]
        second = execute(sent)
        check_moves(sent, second.achieved, second.executed, last)
        held, falls = (winners, theta, jacobian, correction), (self._widths, self._rate)
        kernels.learn(*cells, *held, *first, *second, self._metric, *falls, fraction)
        maps.waiting += 1

    def widths(self, fraction: float) -> np.ndarray:
        """Widths (run, map, 2) of g_k and g_kl after this fraction of the training."""
        start, ends, power = self._widths
        return fall(start, ends, fraction, power)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
        """An untrained learner for a number of runs, from its `settings`."""
        rules: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value
            for name, value in settings["rules"].items()
        }
        schedule = Schedule.of_runs([Schedule(**values) for values in settings["by_run"]])
        return cls(Rules(**rules), schedule, runs=runs)

    def settings(self) -> dict[str, Any]:
        """The rules and, by run, the schedule."""
        by_run = [asdict(self.schedule.of_run(run)) for run in range(self._runs)]
        return {"rules": asdict(self.rules), "by_run": by_run}

    def state(self) -> list[State]:
        """For each run theta (K, L, o) and Jacobians (K, L, o, 6) of each map, by its name."""
        self.maps.settle()
        return [
            {
                name: {"theta": theta[run].copy(), "jacobian": jacobian[run].copy()}
                for name, theta, jacobian in self._held()
            }
            for run in range(self._runs)
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Restore a `state`."""
        self.maps.settle()
        for name, theta, jacobian in self._held():
            theta[:] = [state[name]["theta"] for state in states]
            jacobian[:] = [state[name]["jacobian"] for state in states]

    def _held(self) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
        """The name of each map, its theta (run, K, L, o) and its Jacobians (run, K, L, o, 6)."""
        cells = self.maps.cells
        for each, name in enumerate(self.rules.maps):
            jacobian = cells.jacobian[:, each]
            yield name, cells.theta[:, each], jacobian.reshape(*jacobian.shape[:-1], -1, 6)
