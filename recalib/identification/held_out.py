"""What an identification misses on rows that it was not made from.

Each row is held out in two ways: in a random part of all rows, and with those that are near it in
joint space, where what was learned has to reach farther.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.cluster.vq import kmeans, vq

from recalib.identification.calibration import Calibration
from recalib.identification.linearised import LEVER
from recalib.identification.observations import Observations
from recalib.randomness import generator

FOLDS = 5
COVERED = 0.95  # of what is measured should lie within the intervals

# From observations and how much each counts (n,) in the first step to a calibration.
Fit = Callable[[Observations, np.ndarray], Calibration]


@dataclass(frozen=True)
class HeldOut:
    """What was missed at each row by an identification without it.

    Attributes:
        misses: (n, 3) m, or (n, 6) m and rad, along the axes of the instrument.
        spreads: (n,) m, by how much it should have missed; see `Calibration.spreads`.
        folds: (n,) the number of the part in which a row was held out.
    """

    misses: np.ndarray
    spreads: np.ndarray
    folds: np.ndarray

    def __getitem__(self, rows: np.ndarray) -> "HeldOut":
        return HeldOut(self.misses[rows], self.spreads[rows], self.folds[rows])

    @property
    def errors(self) -> np.ndarray:
        """(n, 1) m or (n, 2) m and rad: how far off, and how far turned."""
        return np.linalg.norm(self.misses.reshape(len(self.misses), -1, 3), axis=2)

    @property
    def losses(self) -> np.ndarray:
        """(n,) m, a turn of one rad as `LEVER`."""
        return self.errors @ np.array([1, LEVER])[: self.errors.shape[1]]

    def factor(self) -> float:
        """The radius that covers 95 % of measured positions, over their spreads.

        The spreads know of noise and of what data left open, not of what no parameter can hold:
        that is in what was missed (split conformal prediction, Lei et al. 2018).
        """
        ratios = self.errors[:, 0] / self.spreads
        rank = min(len(ratios), int(np.ceil((len(ratios) + 1) * COVERED)))
        return float(np.sort(ratios)[rank - 1])

    def coverage(self) -> float:
        """The part of positions within intervals whose factor is that of the other folds."""
        parts = range(self.folds.max() + 1)
        factors = np.array([self[self.folds != fold].factor() for fold in parts])
        return float(np.mean(self.errors[:, 0] <= factors[self.folds] * self.spreads))


def random_folds(seen: Observations) -> np.ndarray:
    """The number (n,) of the part that each row is in; each target and socket is in all of them."""
    random, folds, first = generator(0, "folds"), np.empty(len(seen), dtype=int), 0
    for rows in _groups(seen):
        folds[random.permutation(rows)] = (first + np.arange(len(rows))) % FOLDS
        first += len(rows)
    return folds


def blocks(seen: Observations) -> np.ndarray:
    """Likewise, of parts that lie together in joint space."""
    spread = seen.joints.std(axis=0)
    scaled = seen.joints / np.where(spread > 0, spread, 1)
    random, folds = generator(0, "blocks"), np.empty(len(seen), dtype=int)
    for rows in _groups(seen):
        centres, _ = kmeans(scaled[rows], min(FOLDS, len(rows)), rng=random)
        folds[rows], _ = vq(scaled[rows], centres)
    return folds


def _groups(seen: Observations) -> list[np.ndarray]:
    """Rows of each target, or of each ball in each socket."""
    group = seen.groups
    return [np.flatnonzero(group == one) for one in range(group.max() + 1)]


def hold_out(fit: Fit, seen: Observations, weights: np.ndarray, folds: np.ndarray) -> HeldOut:
    """Identify without each fold in turn, and look at what is missed there."""
    misses, spreads = np.empty((len(seen), 3 * seen.kinds)), np.empty(len(seen))
    for fold in range(folds.max() + 1):
        held = folds == fold
        calibration, asked = fit(seen[~held], weights[~held]), seen[held]
        misses[held] = calibration.misses(asked)
        spreads[held] = calibration.spreads(asked.joints, asked.targets)
    return HeldOut(misses, spreads, folds)
