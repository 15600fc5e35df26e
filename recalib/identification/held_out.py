"""Cross-validation: the errors of an identification on rows that were held out from it.

Each row is held out in two ways: in a random fold of postures, and in a block of joint space, which
tests extrapolation. A posture is held out as a whole, with all its targets and repetitions: any of
its rows would reveal the others.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.cluster.vq import kmeans, vq

from recalib.identification.checks.postures import Postures
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import Optics
from recalib.numerics.randomness import generator

FOLDS = 5
COVERED = 0.95  # of measurements should lie within the intervals


@dataclass(frozen=True)
class HeldOut:
    """The residuals of each row, of an identification without it.

    Attributes:
        residuals: (n, 3) m, or (n, 6) m and rad, along the axes of the instrument.
        folds: (n,) the number of the part in which a row was held out.
        optics: of rows by cameras.
        unseen: (n,) m, how uncertain predicted positions are along the line of sight.
    """

    residuals: np.ndarray
    folds: np.ndarray
    optics: Optics | None = None
    unseen: float | np.ndarray = 0.0

    def __getitem__(self, rows: np.ndarray) -> "HeldOut":
        unseen = np.broadcast_to(self.unseen, len(self.folds))[rows]
        optics = None if self.optics is None else self.optics[rows]
        return HeldOut(self.residuals[rows], self.folds[rows], optics, unseen)

    @property
    def errors(self) -> np.ndarray:
        """(n, 1) m or (n, 2) m and rad: how far off, and how far turned.

        By cameras, how far corners are off across the line of sight, and how uncertain the
        calibration is along it: what a picture measures there is mostly its own noise.
        """
        errors = np.linalg.norm(self.residuals.reshape(len(self.residuals), -1, 3), axis=2)
        if self.optics is not None:
            across = self.optics.across(self.optics.moved(self.residuals))
            errors[:, 0] = np.hypot(across, self.unseen)
        return errors

    @property
    def losses(self) -> np.ndarray:
        """(n,) m, a turn of one rad as `LEVER`."""
        return self.errors @ np.array([1, LEVER])[: self.errors.shape[1]]

    def radius(self, kind: int = 0) -> float:
        """The distance from predictions within which 95 % of each part's measurements lie.

        A covariance counts noise and the parameters' uncertainty, but not errors that no parameter
        describes: they are in the residuals (split conformal prediction, Lei et al. 2018). If parts
        lie apart, their errors differ, and a new place may be as bad as the worst. Kind 0 is of
        position [m], 1 of orientation [rad].
        """
        off, radii = self.errors[:, kind], []
        for fold in np.unique(self.folds):
            some = np.sort(off[self.folds == fold])
            rank = min(len(some), int(np.ceil((len(some) + 1) * COVERED)))
            radii.append(float(some[rank - 1]))  # the least that covers 95 % of others like them
        return max(radii)

    def coverage(self) -> float:
        """The part of positions within the radius of the other folds."""
        within = [
            self[self.folds == fold].errors[:, 0] <= self[self.folds != fold].radius()
            for fold in np.unique(self.folds)
        ]
        return float(np.concatenate(within).mean())


def random_folds(observations: Observations, postures: Postures) -> np.ndarray:
    """The number (n,) of the part that each row is in, with each target or socket in all of them.

    As far as it can be: of a posture, all rows are in one part.
    """
    rng, shown = generator(0, "folds"), observations.groups[postures.first]

    def deal(some: np.ndarray) -> np.ndarray:
        order, parts = rng.permutation(len(some)), np.empty(len(some), dtype=int)
        by_target = order[np.argsort(shown[some[order]], kind="stable")]
        parts[by_target] = np.arange(len(some)) % FOLDS
        return parts

    return _divided(observations, postures, deal)


def blocks(observations: Observations, postures: Postures) -> np.ndarray:
    """Likewise, of parts that lie together in joint space."""
    rng, joints = generator(0, "blocks"), observations.joints[postures.first]
    scaled = joints / np.where(postures.still, np.inf, joints.std(axis=0))

    def cluster(some: np.ndarray) -> np.ndarray:
        centres, _ = kmeans(scaled[some], min(FOLDS, len(some)), rng=rng)
        return vq(scaled[some], centres)[0]

    return _divided(observations, postures, cluster)


def _divided(
    observations: Observations, postures: Postures, divide: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """The part (n,) of each row, by what divides postures (their numbers) into parts.

    A target or a socket whose rows would all be in one part is divided by itself: without any row
    its place is unknown.
    """
    parts, groups = divide(np.arange(len(postures))), observations.groups
    for group in range(groups.max() + 1):
        members = np.unique(postures.numbers[groups == group])
        if np.ptp(parts[members]) == 0:
            parts[members] = divide(members)
    return parts[postures.numbers]
