"""What today's learners share: one move an iteration, and whatever was measured is learned from."""

from abc import ABC, abstractmethod

import numpy as np

from recalib.interfaces import Execute


class Observer(ABC):
    """A learner that learns from any move, whoever chose it."""

    @abstractmethod
    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""

    @abstractmethod
    def observe(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn from moves; nothing is learned from those that were refused.

        Args:
            commands: (run, move, 6) what was sent.
            achieved: (run, move, 6) what came of it.
            executed: (run, move) whether it was carried out.

        Raises BadMeasurement where what came of it is no number, or grossly off.
        """

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One move to the desired poses (run, 6)."""
        commands = self.command(desired[:, None])
        outcome = execute(commands)
        self.observe(commands, outcome.achieved, outcome.executed)
