"""Cross-validation: the errors of an identification on rows that were held out from it.

Each row is held out in two ways: in a random fold of postures, and in a block of joint space, which
tests extrapolation. A posture is held out as a whole, with all its targets and repetitions, since
any of its rows would reveal the others.
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
COVERED = 0.95  # the nominal coverage of the intervals


@dataclass(frozen=True)
class HeldOut:
    """The residual of each row from an identification without it.

    Attributes:
        residuals: (n, 3) m, or (n, 6) m and rad, along the axes of the instrument.
        folds: (n,) the number of the fold in which each row was held out.
        optics: the optics of rows from cameras.
        unseen: (n,) m, standard deviations of predicted positions along the line of sight.
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
        """Errors of position and orientation: (n, 1) m or (n, 2) m and rad.

        For cameras, a position error combines the corners' error across the line of sight with the
        calibration's uncertainty along it, where a picture measures mostly its own noise.
        """
        errors = np.linalg.norm(self.residuals.reshape(len(self.residuals), -1, 3), axis=2)
        if self.optics is not None:
            across = self.optics.across(self.optics.moved(self.residuals))
            errors[:, 0] = np.hypot(across, self.unseen)
        return errors

    @property
    def losses(self) -> np.ndarray:
        """Errors (n,) [m], in which a turn of one rad counts as `LEVER`."""
        return self.errors @ np.array([1, LEVER])[: self.errors.shape[1]]

    def radius(self, kind: int = 0) -> float:
        """The distance from predictions within which 95 % of each fold's measurements lie.

        A covariance holds noise and the parameters' uncertainty, but not errors that no parameter
        describes. Residuals contain them (split conformal prediction, Lei et al. 2018). The errors
        of folds that lie apart differ, and a new place may be as bad as the worst fold. Kind 0 is
        position [m], 1 orientation [rad].
        """
        off, radii = self.errors[:, kind], []
        for fold in np.unique(self.folds):
            errors = np.sort(off[self.folds == fold])
            rank = min(len(errors), int(np.ceil((len(errors) + 1) * COVERED)))
            radii.append(float(errors[rank - 1]))  # the least radius for 95 % of rows like these
        return max(radii)

    def coverage(self) -> float:
        """The fraction of positions within the radius from the other folds."""
        within = [
            self[self.folds == fold].errors[:, 0] <= self[self.folds != fold].radius()
            for fold in np.unique(self.folds)
        ]
        return float(np.concatenate(within).mean())


def random_folds(observations: Observations, postures: Postures) -> np.ndarray:
    """The fold (n,) of each row; each fold has rows of each target or socket if possible.

    All rows of a posture are in one fold.
    """
    rng, shown = generator(0, "folds"), observations.groups[postures.first]

    def deal(members: np.ndarray) -> np.ndarray:
        order, folds = rng.permutation(len(members)), np.empty(len(members), dtype=int)
        by_target = order[np.argsort(shown[members[order]], kind="stable")]
        folds[by_target] = np.arange(len(members)) % FOLDS
        return folds

    return _divided(observations, postures, deal)


def blocks(observations: Observations, postures: Postures) -> np.ndarray:
    """The fold (n,) of each row, where each fold is a cluster in joint space."""
    rng, joints = generator(0, "blocks"), observations.joints[postures.first]
    scaled = joints / np.where(postures.still, np.inf, joints.std(axis=0))

    def cluster(members: np.ndarray) -> np.ndarray:
        centres, _ = kmeans(scaled[members], min(FOLDS, len(members)), rng=rng)
        return vq(scaled[members], centres)[0]

    return _divided(observations, postures, cluster)


def _divided(
    observations: Observations, postures: Postures, divide: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """The fold (n,) of each row, from a function that divides postures (by number) into folds.

    If all rows of a target or socket would be in one fold, they are divided separately: without any
    row, its place would be unknown.
    """
    folds, groups = divide(np.arange(len(postures))), observations.groups
    for group in range(groups.max() + 1):
        members = np.unique(postures.numbers[groups == group])
        if np.ptp(folds[members]) == 0:
            folds[members] = divide(members)
    return folds[postures.numbers]
