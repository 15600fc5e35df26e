"""The nominal controller without corrections: the baseline for every learner."""

import numpy as np

from recalib.learners.observer import Observer


class UncorrectedLearner(Observer):
    """A baseline that commands the desired poses and learns nothing."""

    def command(self, desired: np.ndarray) -> np.ndarray:
        """The desired poses (run, pose, 6) themselves."""
        return desired

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn nothing."""
