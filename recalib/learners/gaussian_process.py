"""A black box: Gaussian processes for the correction of the command, knowing nothing of arms."""

from collections.abc import Mapping

import numpy as np

from recalib.interfaces import Execute
from recalib.learners.experience import Experience, is_due
from recalib.processes import Process, is_time_to_search


class GaussianProcessLearner:
    """The correction, command minus achieved pose, as a Gaussian process over the achieved coordinates.

    Hyperparameters are sought anew whenever the number of moves has doubled, up to `processes.MOST` of them.

    Args:
        runs: how many independent trainings.
    """

    def __init__(self, runs: int):
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

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One move to the desired poses (run, 6); nothing is learned where it is refused."""
        commands = self.command(desired[:, None])
        outcome = execute(commands)
        self.observe(commands, outcome.achieved, outcome.executed)

    def observe(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves: commands (run, move, 6), achieved (run, move, 6), executed (run, move)."""
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

    def state(self) -> dict[str, np.ndarray]:
        """The moves, and for each run the process."""
        arrays = self._experience.state()
        for run, process in enumerate(self._processes):
            if process is not None:
                arrays |= {f"{run}/{name}": value for name, value in process.state().items()}
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Take over what `state` returned."""
        self._experience.restore(arrays)
        for run in range(len(self._processes)):
            own = {
                name.split("/")[1]: value
                for name, value in arrays.items()
                if name.startswith(f"{run}/")
            }
            self._processes[run] = Process(**own) if own else None
