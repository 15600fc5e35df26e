"""A black box: Gaussian processes for the correction of the command, without an arm's model."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from recalib.learners.experience import Experience, is_due
from recalib.learners.observer import Observer
from recalib.loop.interfaces import State
from recalib.numerics.regression import Process, is_time_to_search

if TYPE_CHECKING:
    from recalib.nominal.robots import Robot


class GaussianProcessLearner(Observer):
    """The correction, command minus achieved pose, as a Gaussian process of the achieved pose.

    Hyperparameters are sought anew whenever the number of moves has doubled, up to
    `regression.MOST` of them.

    Args:
        runs: how many independent trainings.
    """

    def __init__(self, *, runs: int = 1):
        self._experience = Experience(runs)
        self._processes: list[Process | None] = [None] * runs

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        return np.stack(
            [
                poses if process is None else poses + process.predict(poses)
                for poses, process in zip(desired, self._processes, strict=True)
            ]
        )

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        before = self._experience.moves
        self._experience.add(commands, achieved, executed)
        if is_due(before, self._experience.moves):
            search = is_time_to_search(before, self._experience.moves)
            for run, process in enumerate(self._processes):
                self._processes[run] = self._fit(run, process, search)

    def _fit(self, run: int, last: Process | None, search: bool) -> Process | None:
        commands, achieved = self._experience.of(run)
        if not len(commands):
            return None
        known = None if last is None or search else last.hyperparameters
        return Process(achieved, commands - achieved, known)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], runs: int, robot: "Robot") -> Self:
        """The learner of so many runs that has learned nothing; there are no settings."""
        return cls(runs=runs)

    def settings(self) -> dict[str, Any]:
        """It has none."""
        return {}

    def state(self) -> list[State]:
        """For each run its moves and, once there is one, its process."""
        return [
            {"moves": moves, "process": process and process.state()}
            for moves, process in zip(self._experience.state(), self._processes, strict=True)
        ]

    def restore(self, states: Sequence[State]) -> None:
        """Take over what `state` returned."""
        self._experience.restore([state["moves"] for state in states])
        self._processes = [
            Process(**state["process"]) if state.get("process") else None for state in states
        ]
