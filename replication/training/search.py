"""A search for the best settings of a learner, and the measurement that it has converged.

All settings are sought at once by CMA-ES, a generation side by side. Several searches, each with a
seed and poses of its own, have converged when what their winners leave, on fresh poses, differs by
a few percent at most. Until then all of them begin once more with generations twice as large and
twice as many trials, which finds better optima where there are several (Auger and Hansen 2005).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from cmaes import CMA
from scipy.stats import qmc

from replication.config.campaign import RoughSearch
from replication.config.study import SearchSettings
from replication.training.poses import SearchPoses
from replication.training.settings import FIRST_RATE, INITIAL, LAST_RATE
from replication.training.trials import Trials

Score = Callable[[np.ndarray], np.ndarray]  # from shares (trial, 2) to what is minimised (trial,)

GENERATION = 16  # trials side by side, at first
# About which the first generation lies, in [0, 1]^d: wide neighbourhoods that become narrow.
MIDDLE = {INITIAL: 0.75, FIRST_RATE: 0.85, LAST_RATE: 0.7}
WIDTH = 0.65
SPREAD, NEARBY = 0.25, 0.08  # its standard deviation; and about a start that is nearly right


def worse(shares: np.ndarray) -> np.ndarray:
    """The larger remaining share: neither error can be bought with the other."""
    return shares.max(axis=-1)


class Search:
    """One search, which can begin again.

    Args:
        trials: what it tries, on poses of its own.
        score: what it minimises.
        seed: of CMA-ES.
        start: a row of settings near which to begin; from the middle of the ranges without one.

    Attributes:
        tried: how many settings.
        best: (column,) the row with the least score.
    """

    def __init__(self, trials: Trials, score: Score, seed: int, start: np.ndarray | None):
        self._trials, self._score, self._seed, self._start = trials, score, seed, start
        self.tried, self.best, self._least = 0, np.empty(len(trials.space.columns)), np.inf

    def begin(self, trials: int, times: int) -> None:
        """Try up to so many settings, in generations that are so many times as large."""
        space, start = self._trials.space, self._start
        middle = np.array([MIDDLE.get(name, WIDTH) for name in space.coordinates])
        optimiser = CMA(
            middle if start is None else space.point(start),
            SPREAD if start is None else NEARBY * times,
            bounds=np.tile([0.0, 1.0], (len(middle), 1)),
            seed=self._seed + self.tried,
            population_size=GENERATION * times,
        )
        enough = self.tried + trials
        while self.tried < enough and not optimiser.should_stop():
            points = np.array([optimiser.ask() for _ in range(optimiser.population_size)])
            rows = space.rows(points)
            scores = np.nan_to_num(self._score(self._trials.shares(rows)), nan=np.inf, posinf=1e9)
            optimiser.tell(list(zip(points, scores.tolist(), strict=True)))
            self.tried += len(rows)
            if scores.min() < self._least:
                self._least, self.best = scores.min(), rows[scores.argmin()]


class Winners(NamedTuple):
    """What several searches found.

    Attributes:
        rows: (search, column) settings.
        shares: (search, 2) that remain of the arm's errors on fresh poses.
        scores: (search,) of these shares.
        trials: of each search.
        settled: whether the searches have converged.
    """

    rows: np.ndarray
    shares: np.ndarray
    scores: np.ndarray
    trials: int
    settled: bool

    @property
    def best(self) -> np.ndarray:
        """The row (column,) that leaves least."""
        return self.rows[self.scores.argmin()]


@dataclass(frozen=True)
class Tuning:
    """Searches for the settings of one training.

    Attributes:
        trials: of each search, on poses of its own.
        fresh: on poses that no search uses.
        plan: how thoroughly; its seed is that of the first search.

    Raises TypeError: poses are for results.
    """

    trials: Sequence[Trials]
    fresh: Trials
    plan: SearchSettings

    def __post_init__(self) -> None:
        for its in (*self.trials, self.fresh):
            SearchPoses.only(its.poses)

    def rough(self, effort: RoughSearch) -> Winners:
        """The best of few quasi-random settings, by each search: as one finds them by hand."""
        space = replace(self.fresh.space, ranges=effort.ranges)
        rows = []
        for number, its in enumerate(self.trials):
            random = np.random.default_rng(self.plan.seed + number)
            points = qmc.Sobol(len(space.coordinates), rng=random).random(effort.trials)
            tried = space.rows(points)
            rows.append(tried[worse(its.first(1).shares(tried)).argmin()])
        shares = self.fresh.shares(np.stack(rows))
        return Winners(np.stack(rows[:1]), shares[:1], worse(shares[:1]), effort.trials, False)

    def search(self, score: Score = worse, starts: np.ndarray | None = None) -> Winners:
        """The winners, once the searches have converged or may not go on.

        Args:
            starts: (search, column) rows near which to begin.
        """
        searches = [
            Search(its, score, self.plan.seed + number, None if starts is None else starts[number])
            for number, its in enumerate(self.trials)
        ]
        trials = self.plan.trials if starts is None else self.plan.near_trials
        for times in (2**doubling for doubling in range(self.plan.doublings + 1)):
            for its in searches:
                its.begin(trials * times, times)
            rows = np.stack([its.best for its in searches])
            shares = self.fresh.shares(rows)
            scores = score(shares)
            if scores.max() <= (1 + self.plan.within) * scores.min():
                return Winners(rows, shares, scores, searches[0].tried, settled=True)
        return Winners(rows, shares, scores, searches[0].tried, settled=False)
