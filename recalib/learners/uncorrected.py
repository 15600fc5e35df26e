"""The nominal controller, left to itself: what every learner has to beat."""

from collections.abc import Mapping

import numpy as np

from recalib.interfaces import Execute


class UncorrectedLearner:
    """Commands what is desired, and learns nothing."""

    def command(self, desired: np.ndarray) -> np.ndarray:
        """The desired poses (run, pose, 6) themselves."""
        return desired

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """Make the move that the others make, and no use of it."""
        execute(desired[:, None])

    def state(self) -> dict[str, np.ndarray]:
        """Nothing."""
        return {}

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Nothing to take over."""
