"""The cells of a map while it learns: which one won, and what each has learned."""

from dataclasses import dataclass

import numpy as np

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.nominal.poses import POSITION, Workspace


@dataclass(frozen=True)
class Cells:
    """The supernet's cells of the map that gives positions, seen at each measurement.

    Attributes:
        centres: (cell, 3) m in the base frame.
        weights: (measurement, cell) of the neighbourhood g_k about the last winner, in [0, 1]; zero
            before the first.
        corrections: (measurement, cell, 3) m along the base's axes, by which learning moved the
            position commands of a cell, the mean over its subnet.
    """

    centres: np.ndarray
    weights: np.ndarray
    corrections: np.ndarray


class CellWatch:
    """Looks at the cells of a learner of one run, fresh when it is made.

    Args:
        desired: (iteration, 6) poses that it will learn from.
    """

    def __init__(self, learner: HierarchicalLearner, workspace: Workspace, desired: np.ndarray):
        self._learner, self._workspace, self._desired = learner, workspace, desired
        self._name, self._map = next(iter(learner.maps.items()))
        self._untrained = self._theta().copy()
        self._weights: list[np.ndarray] = []
        self._corrections: list[np.ndarray] = []

    def look(self, iteration: int) -> None:
        """See what so many iterations have made of them."""
        moved = (self._theta() - self._untrained).mean(axis=1)
        self._corrections.append(moved * self._workspace.half_ranges[POSITION])
        self._weights.append(self._neighbourhood(iteration))

    def seen(self) -> Cells:
        """All that was seen."""
        w_k, half_ranges = self._learner.nets.w_k, self._workspace.half_ranges[POSITION]
        return Cells(
            centres=self._workspace.centre[:3, 3] + w_k * half_ranges,
            weights=np.stack(self._weights),
            corrections=np.stack(self._corrections),
        )

    def _theta(self) -> np.ndarray:
        return self._map.theta.all[0, ..., POSITION]

    def _neighbourhood(self, iteration: int) -> np.ndarray:
        """g_k (cell,) in the iteration before; zero where there was none."""
        learner, last = self._learner, iteration - 1
        nets = learner.nets
        if iteration == 0:
            return np.zeros(len(nets.w_k))
        winner = nets.winner(self._desired[[last]])
        done = last / len(self._desired)
        widths = learner.rules.widths(learner.schedule, self._name, done)
        return nets.neighbourhood(*winner, *widths)[0][0]
