"""What today's learners share: one move an iteration, and learning from every measured move."""

from abc import ABC, abstractmethod

import numpy as np

from recalib.loop.interfaces import Execute
from recalib.loop.moves import Moves, check_moves


class Observer(ABC):
    """A learner that learns from any move, whoever chose it."""

    _last: Moves | None = None  # the move with which the next is compared

    @abstractmethod
    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    def observe(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves; nothing is learned from those that were refused.

        Args:
            commands: (run, move, 6) what was sent.
            achieved: (run, move, 6) what came of it.
            executed: (run, move) whether it was carried out.

        Raises BadMeasurement if the achieved pose is not a number, far off, or the same for all
        commands; then nothing is learned.
        """
        self._last = check_moves(commands, achieved, executed, self._last)
        self._update(commands, achieved, executed)

    @abstractmethod
    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves that are sound; see `observe`."""

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One move to the desired poses (run, 6)."""
        commands = self.command(desired[:, None])
        outcome = execute(commands)
        self.observe(commands, outcome.achieved, outcome.executed)
