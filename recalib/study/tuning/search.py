"""A search for the best settings of a learner, and the measurement that it has converged.

All settings are sought at once by CMA-ES, a generation side by side. Several searches, each with a
seed and poses of its own, have converged when their winners remain within a few percent of one
another on fresh poses. Until then, all go on with as many more trials.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from cmaes import CMA

from recalib.study.configuration.study import Convergence, Ranges
from recalib.study.tuning.settings import columns, point, rows
from recalib.study.tuning.trials import Trials

Score = Callable[[np.ndarray], np.ndarray]  # from shares (trial, 2) to what is minimised (trial,)

GENERATION = 16  # trials side by side
# The first generation, in [0, 1]^d: wide neighbourhoods that become half as wide as cells are apart.
MIDDLE = {"initial_width": 0.75, "initial_rate": 0.85, "final_rate": 0.7}
WIDTH = 0.65
SPREAD, NEARBY = 0.25, 0.08  # its standard deviation; and about a start that is nearly right


def worse(shares: np.ndarray) -> np.ndarray:
    """The larger remaining share: neither error can be bought with the other."""
    return shares.max(axis=-1)


class Search:
    """One search, which can go on.

    Args:
        trials: what it tries.
        ranges: of the settings.
        score: what it minimises.
        seed: of CMA-ES.
        start: settings (d,) near which to begin; from the middle of the ranges unless given.
    """

    def __init__(
        self, trials: Trials, ranges: Ranges, score: Score, seed: int, start: np.ndarray | None
    ):
        self._trials, self._ranges, self._score = trials, ranges, score
        names = columns(trials.rules)
        mean = np.array([MIDDLE.get(name, WIDTH) for name in names])
        self._optimiser = CMA(
            mean if start is None else point(start, ranges),
            SPREAD if start is None else NEARBY,
            bounds=np.tile([0.0, 1.0], (len(names), 1)),
            seed=seed,
            population_size=GENERATION,
        )
        self.tried, self.least, self.best = 0, np.inf, np.empty(len(names))

    def go_on(self, trials: int) -> None:
        """Try so many more settings, up to the end of a generation."""
        enough = self.tried + trials
        while self.tried < enough:
            points = np.array([self._optimiser.ask() for _ in range(GENERATION)])
            settings = rows(points, self._ranges)
            scores = self._score(self._trials.shares(settings))
            scores = np.where(np.isfinite(scores), scores, np.finfo(float).max)
            self._optimiser.tell(list(zip(points, scores.tolist(), strict=True)))
            self.tried += GENERATION
            if scores.min() < self.least:
                self.least, self.best = scores.min(), settings[scores.argmin()]


@dataclass(frozen=True)
class Winners:
    """What several searches found.

    Attributes:
        settings: (search, d) rows; see `recalib.study.tuning.settings`.
        shares: (search, 2) that remain of the arm's errors on fresh poses.
        trials: of each search.
        settled: whether the searches have converged.
    """

    settings: np.ndarray
    shares: np.ndarray
    trials: int
    settled: bool


def search(
    trials: Sequence[Trials],
    fresh: Trials,
    ranges: Ranges,
    budget: Convergence,
    seed: int,
    score: Score = worse,
    starts: Sequence[np.ndarray | None] | None = None,
) -> Winners:
    """The winners of several searches, once they have converged or may not go on.

    Args:
        trials: of each search, on poses of its own.
        fresh: on poses that no search uses.
        seed: of CMA-ES, with the number of the search.
        starts: where each begins; see `Search`.
    """
    starts = starts or [None] * len(trials)
    searches = [
        Search(its, ranges, score, seed + number, start)
        for number, (its, start) in enumerate(zip(trials, starts, strict=True))
    ]
    further = budget.trials
    for doubling in range(budget.doublings + 1):
        for its in searches:
            its.go_on(further)
        settings = np.stack([its.best for its in searches])
        shares = fresh.shares(settings)
        scores = score(shares)
        settled = bool(scores.max() <= (1 + budget.within) * scores.min())
        if settled or doubling == budget.doublings:
            break
        further = searches[0].tried
    return Winners(settings, shares, searches[0].tried, settled)
