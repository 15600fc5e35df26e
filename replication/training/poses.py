"""Poses for training and testing. No result is measured on poses that were used to choose settings.

The type of a stream of random poses shows whether it is for a search or for results, and code for
one refuses the other. Streams are only named here.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, unique
from typing import Any, Self

import numpy as np
import scipy  # loads its subpackages, which are slow to import, at their first use

from recalib.loop.interfaces import Commandable, Learner
from recalib.loop.training import History, train
from recalib.numerics.randomness import generator

SEARCHED = "search "  # first word of the names of search streams, and of no others


@unique
class Stream(Enum):
    """The purposes of random poses."""

    SEARCH = "search {number} in setup {setup}, replicate {replicate}"  # number 0: fresh poses
    SETUP = "setup {setup}, replicate {replicate}"
    SCENARIO = "{scenario}"
    ENSEMBLE = "ensemble"
    TWIN = "twin"
    REPLAY = "replay"
    WIDTHS = "constant widths"
    RATES = "search for a rate with {widths} widths"

    def draw(
        self,
        seed: int,
        runs: Sequence[int],
        iterations: int,
        tests: int,
        order: str = "random",
        **words: str | int,
    ) -> "SearchPoses | ResultPoses":
        """The poses of runs: the same for every learner; fewer iterations get the first poses.

        Args:
            iterations, tests: numbers of poses that a run learns from, and is measured on.
            order: order of the poses to learn from. "random": independent; "even": a scrambled
                Sobol sequence.
            words: values for the name. Raises ValueError if the name becomes that of a search.
        """
        name, searched = self.value.format(**words), self.value.startswith(SEARCHED)
        if name.startswith(SEARCHED) and not searched:
            raise ValueError(f"stream {self.name}: {name!r} is the name of a search")
        kind = SearchPoses if searched else ResultPoses

        def drawn(use: str, count: int, how: str) -> np.ndarray:
            return np.stack([_poses(generator(seed, name, run, use), count, how) for run in runs])

        return kind(name, drawn("desired", iterations, order), drawn("tests", tests, "random"))


def _poses(random: np.random.Generator, count: int, order: str) -> np.ndarray:
    if order == "random":
        return random.uniform(-1, 1, (count, 6))
    sobol = scipy.stats.qmc.Sobol(6, rng=random)
    return 2 * sobol.random_base2((count - 1).bit_length())[:count] - 1


@dataclass(frozen=True)
class _Poses:
    """Poses of several runs, in workspace coordinates. Raises ValueError if the sets overlap."""

    name: str  # the name of their stream
    desired: np.ndarray  # (run, iteration, 6) to learn from
    tests: np.ndarray  # (run, pose, 6) to measure on

    def __post_init__(self) -> None:
        if np.isin(self.tests[..., 0], self.desired[..., 0]).any():
            raise ValueError(f"{self.name}: test poses are among those to learn from")

    @classmethod
    def only(cls, poses: "SearchPoses | ResultPoses") -> Self:
        """The poses themselves. Raises TypeError if they have another purpose."""
        if not isinstance(poses, cls):
            raise TypeError(f"{cls.__name__} expected, {type(poses).__name__} found: {poses.name}")
        return poses


class SearchPoses(_Poses):
    """Poses with which a search chooses settings."""


class ResultPoses(_Poses):
    """Poses on which winners of searches, and today's learners, are trained and measured."""


def train_on(
    plant: Commandable,
    learner: Learner,
    poses: SearchPoses | ResultPoses,
    measure_at: Sequence[int],
    **how: Any,
) -> History:
    """Like `recalib.loop.training.train`, for a set of poses."""
    return train(plant, learner, poses.desired, poses.tests, measure_at, **how)


def train_for_results(
    plant: Commandable,
    learner: Learner,
    poses: SearchPoses | ResultPoses,
    measure_at: Sequence[int],
    **how: Any,
) -> History:
    """Like `train_on`. Raises TypeError if the poses belong to a search."""
    return train_on(plant, learner, ResultPoses.only(poses), measure_at, **how)
