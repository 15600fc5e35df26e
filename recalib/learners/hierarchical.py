"""The learners of the paper: hierarchical maps with Ritter's rules or the improved rules."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any, Self

import numpy as np

from recalib.arrays import array_of
from recalib.errors import check_function, check_kind
from recalib.learners import cell_loops
from recalib.learners.cell_loops import JACOBIAN, THETA, WAITING, Cells
from recalib.learners.nets import Nets
from recalib.learners.rules import Rules
from recalib.learners.schedules import Schedule, fall
from recalib.loop.interfaces import Execute, State
from recalib.loop.moves import check_moves
from recalib.nominal.robots import Robot


class HierarchicalLearner:
    """Hierarchical maps with the learning cycle of section 2, without its first step.

    The centres of the cells do not move (section 3). Cells start as the identity, which is exact
    for the intact robot (section 3). If values of theta are propagated, they may start at random,
    like Ritter's: later values replace them. Increments never replace the start, and a random or
    zero Jacobian is never replaced either, so these start as the identity.

    Runs are independent of one another.

    Args:
        rules: the learning rules.
        schedule: the fall of widths and rates.
        runs: number of independent trainings.

    Attributes:
        nets: the centres of the cells, the same in all maps.
        cells: their contents, without pending updates: see `recalib.learners.cell_loops`.

    Raises InvalidSetting if the schedule has other maps than the rules, or another number of runs.
    """

    def __init__(self, rules: Rules, schedule: Schedule, *, runs: int = 1):
        check_kind("rules", rules, Rules)
        check_kind("schedule", schedule, Schedule)
        self.rules, self.schedule = rules, schedule.over(runs)
        self.nets = Nets(rules.supernet, rules.subnet, rules.centres, rules.width_units)
        self._runs, self._waiting = runs, 0  # updates
        self.cells = self._untrained()
        self._increments = rules.theta_increments, rules.jacobian_increments
        self._metric = np.square(np.asarray(rules.metric, dtype=float))
        self._widths = *self.schedule.widths(rules.maps), rules.width_power
        start, end = np.asarray(self.schedule.initial_rate), np.asarray(self.schedule.final_rate)
        self._rate = start, end, rules.rate_power

    def _untrained(self) -> Cells:
        nets, rules = self.nets, self.rules
        shape, maps = nets.centres.shape[:2], len(rules.maps)
        theta = nets.centres
        if rules.initial is not None and not rules.theta_increments:
            theta = np.random.default_rng(rules.initial).uniform(-1, 1, theta.shape)
        jacobian = np.broadcast_to(np.eye(6).ravel(), (*shape, 36))
        theta, jacobian = (  # `repeat` returns C order, in which `_settle` is fastest
            np.repeat(np.stack(np.split(start, maps, axis=-1))[None], self._runs, axis=0)
            for start in (theta, jacobian)
        )
        waiting = self._runs, maps, WAITING
        return Cells(
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
            rates=np.zeros((self._runs, WAITING, 2)),
        )

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6), by (1).

        Raises InvalidSetting for another shape or NaN.
        """
        desired = array_of("desired", desired, (self._runs, "n", 6))
        self._settle()
        return cell_loops.commands(tuple(self.cells), desired)

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One learning cycle with its two moves; see `Learner.learn`.

        Nothing is learned from a refused move. Raises BadMeasurement if the achieved pose
        is not a number, far off, or the same for all commands, and InvalidSetting: another shape.
        """
        desired = array_of("desired", desired, (self._runs, 6))
        array_of("fraction", fraction, ())
        check_function("execute", execute)
        if self._waiting == WAITING:
            self._settle()
        cells = tuple(self.cells), self._waiting, self._increments
        command, winners, theta, jacobian = cell_loops.respond(*cells, desired)
        sent = command[:, None]
        first = execute(sent)
        last = check_moves(sent, first.achieved, first.executed)
        correction = cell_loops.corrections(jacobian, desired, first.achieved)
        sent = (command + correction)[:, None]
        second = execute(sent)
        check_moves(sent, second.achieved, second.executed, last)
        response, falls = (winners, theta, jacobian, correction), (self._widths, self._rate)
        cell_loops.learn(*cells, *response, *first, *second, self._metric, *falls, fraction)
        self._waiting += 1

    def _settle(self) -> None:
        """Apply the pending updates, run by run, so that a run's data fit into the cache."""
        waiting, self._waiting, cells = slice(self._waiting), 0, self.cells
        if not waiting.stop:
            return
        for run, map_ in np.ndindex(cells.theta.shape[:2]):
            here, rates = (run, map_, waiting), cells.rates[run, waiting]
            g_k, g_kl = cells.g_k[here], cells.g_kl[here]
            theta, jacobian = cells.theta[run, map_], cells.jacobian[run, map_]
            star = cells.theta_star[here]
            _apply(theta, rates[:, THETA], g_k, g_kl, star, self._increments[THETA])
            star = cells.jacobian_star[here]
            _apply(jacobian, rates[:, JACOBIAN], g_k, g_kl, star, self._increments[JACOBIAN])

    def widths(self, fraction: float) -> np.ndarray:
        """Widths (run, map, 2) of g_k and g_kl after this fraction of the training."""
        start, ends, power = self._widths
        return fall(start, ends, fraction, power)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: Robot) -> Self:
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
        self._settle()
        return [
            {
                name: {"theta": theta[run].copy(), "jacobian": jacobian[run].copy()}
                for name, theta, jacobian in self._by_map()
            }
            for run in range(self._runs)
        ]

    def restore(self, states: Sequence[State]) -> None:
        self._settle()
        for name, theta, jacobian in self._by_map():
            theta[:] = [state[name]["theta"] for state in states]
            jacobian[:] = [state[name]["jacobian"] for state in states]

    def _by_map(self) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
        """The name of each map, its theta (run, K, L, o) and its Jacobians (run, K, L, o, 6)."""
        cells = self.cells
        for map_, name in enumerate(self.rules.maps):
            jacobian = cells.jacobian[:, map_]
            yield name, cells.theta[:, map_], jacobian.reshape(*jacobian.shape[:-1], -1, 6)


def _apply(
    values: np.ndarray,
    rate: np.ndarray,
    g_k: np.ndarray,
    g_kl: np.ndarray,
    star: np.ndarray,
    increments: bool,
) -> None:
    """Add increments to cells (K, L, n), (7) and (9), or draw them to values, (4) and (5)."""
    if increments:
        weighted = rate[:, None] * g_k
        values += (weighted.T @ cell_loops.spread_over(g_kl, star)).reshape(values.shape)
    else:
        weights, remaining = cell_loops.lasting(rate, g_k, g_kl)
        cell_loops.draw(values, remaining, weights.T @ star)
