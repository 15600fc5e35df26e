"""A black box: Gaussian processes for the correction of the command, without an arm's model."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from recalib.learners.observer import Refitting
from recalib.numerics.regression import Process, is_time_to_search


class GaussianProcessLearner(Refitting):
    """The correction, command minus achieved pose, as a Gaussian process of the achieved pose.

    Hyperparameters are sought anew whenever the number of moves passes a power of two, up to
    `regression.MOST` of them.
    """

    MODEL = "process"

    def command(self, desired: np.ndarray) -> np.ndarray:
        return np.stack(
            [
                poses if process is None else poses + process.predict(poses)
                for poses, process in zip(desired, self.models, strict=True)
            ]
        )

    def _fit(
        self, sent: np.ndarray, achieved: np.ndarray, last: Process | None, before: int
    ) -> Process:
        if last is None or is_time_to_search(before, self.moves):
            return Process(achieved, sent - achieved)
        return Process(achieved, sent - achieved, last.hyperparameters)

    def _restored(self, state: Mapping[str, Any]) -> Process:
        return Process(**state)
