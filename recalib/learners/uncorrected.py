"""The nominal controller without corrections: the baseline of every learner."""

import numpy as np

from recalib.learners.observer import Observer


class UncorrectedLearner(Observer):
    """Commands what is desired. It makes the moves that the others make, and no use of them."""

    def command(self, desired: np.ndarray) -> np.ndarray:
        """The desired poses (run, pose, 6) themselves."""
        return desired

    def _update(self, commands: np.ndarray, achieved: np.ndarray, executed: np.ndarray) -> None:
        """Learn nothing."""
