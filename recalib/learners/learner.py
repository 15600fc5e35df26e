"""What a learner is: given a desired pose, what command; given what happened, what to learn."""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from recalib.damaged.plant import Outcome

Execute = Callable[[np.ndarray], Outcome]


class Learner(Protocol):
    """What an experiment asks of a learner: nothing but pose commands and measured poses pass between it and a robot.

    Coordinates are those of the workspace. The first axis is always the run: a learner trains many runs side by side.
    """

    def command(self, desired: np.ndarray) -> np.ndarray:
        """Pose commands (run, pose, 6) for the desired poses (run, pose, 6)."""
        ...

    def learn(self, desired: np.ndarray, execute: Execute, fraction: float) -> None:
        """One iteration: try the desired poses (run, 6) with moves through `execute`, and learn from what they achieve.

        Args:
            fraction: of the training that is done, in [0, 1).
        """
        ...

    def state(self) -> dict[str, np.ndarray]:
        """What was learned, as named arrays: enough to rebuild the learner."""
        ...
