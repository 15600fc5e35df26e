"""Cross-validated errors of calibrations, and the choice among them.

The residuals of the fit do not show the errors: a Gaussian process interpolates.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from recalib.identification.calibration import Calibration, calibrations, choose, with_pattern
from recalib.identification.checks.diagnostics import check_estimate, check_links, check_postures
from recalib.identification.checks.postures import Postures, find_postures
from recalib.identification.consensus import identify_by_consensus
from recalib.identification.estimation import LEAST_NOISE, Identification
from recalib.identification.held_out import HeldOut, blocks, random_folds
from recalib.identification.model.error_model import (
    JOINT_ERRORS,
    JOINT_WAVES,
    NO_ERRORS,
    OFFSETS,
    ErrorModel,
    JointTerms,
    held,
)
from recalib.identification.model.frames import Frames
from recalib.identification.model.observations import Observations
from recalib.identification.unseen import Unseen
from recalib.nominal.kinematics import Arm

NOTHING, GEOMETRIC, HYBRID = KINDS = "nothing", "geometric", "hybrid"  # the simplest first
# Held-out errors on postures away from the measured ones, and among them. The first are the
# accuracy to expect of a calibration.
BLOCKWISE, RANDOM = WAYS = "in blocks", "at random"
OUTLYING = 0.1  # rows with less weight are gross outliers: ten standard deviations off
CANDIDATES = OFFSETS, JOINT_ERRORS, JOINT_WAVES  # the candidate joint terms
SURE = 2.0  # standard errors by which a richer calibration must be better to be chosen


@dataclass(frozen=True)
class Validation:
    """Held-out errors, and the calibrations from all rows.

    Attributes:
        held_out: by way of folding and by kind of calibration. Unknown frames are identified for
            the kind "nothing", too, but nothing else is.
        postures: the postures of all rows.
        counted: (n,) whether a row counts for the choice and in errors; others are gross outliers.
        lost: by way of folding, (n,) whether only the fold of a row determines some direction of
            the geometry: without the fold it is not identifiable, and errors show only that.
        full: the calibrations from all rows, by kind.
        unsettled: whether errors beyond geometry were found, but did not converge.
    """

    held_out: Mapping[str, Mapping[str, HeldOut]]
    postures: Postures
    counted: np.ndarray
    lost: Mapping[str, np.ndarray]
    full: Mapping[str, Calibration]
    unsettled: bool

    @cached_property
    def chosen(self) -> str:
        """The simplest kind (nothing, geometric, hybrid) that no richer kind beats significantly.

        Errors on postures away from the training postures decide.
        """
        judged = self.judged(BLOCKWISE)
        _, posture = np.unique(self.postures.numbers[judged], return_inverse=True)
        losses = {kind: self.held_out[BLOCKWISE][kind][judged].losses for kind in KINDS}
        best, *richer = KINDS
        for kind in richer:
            # rows of one posture have correlated errors, so their mean is one gain
            gains = np.bincount(posture, losses[best] - losses[kind]) / np.bincount(posture)
            if gains.mean() > max(SURE * gains.std(ddof=1) / np.sqrt(len(gains)), LEAST_NOISE):
                best = kind
        return best

    @property
    def calibration(self) -> Calibration:
        """The chosen calibration from all rows."""
        return self.full[self.chosen]

    def judged(self, way: str) -> np.ndarray:
        """Whether the errors of each row (n,) count: all but outliers and `lost` rows.

        If fewer than two folds would remain, all but outliers count.
        """
        judged = self.counted & ~self.lost[way]
        folds = self.held_out[way][NOTHING].folds[judged]
        return judged if len(np.unique(folds)) > 1 else self.counted

    def held_out_by(self, way: str, kind: str) -> HeldOut:
        """The held-out residuals of the rows whose errors count."""
        return self.held_out[way][kind][self.judged(way)]

    def mean_error(self, way: str, kind: str) -> float:
        """The mean position error [m] over the rows that count."""
        return float(self.held_out_by(way, kind).errors[:, 0].mean())

    @property
    def radius(self) -> float:
        """The distance [m] from predictions within which 95 % of measured positions lie.

        It is that of the chosen calibration, and holds in postures away from the measured ones.
        """
        return self.held_out_by(BLOCKWISE, self.chosen).radius()

    def coverage(self, way: str) -> float:
        """The fraction of held-out positions within a radius that was computed without them."""
        return self.held_out_by(way, self.chosen).coverage()


def validate(
    arm: Arm,
    observations: Observations,
    frames: Frames | None = None,
    on_progress: Callable[[str], None] = lambda text: None,
) -> Validation:
    """Calibrate an arm in several ways, and cross-validate each.

    The hybrid is geometry with joint errors and a Gaussian process of the residuals, if all rows
    together show either. For each fold, everything is identified and chosen anew, except the
    process's hyperparameters. A joint that stood still has no errors: its link has them.

    Args:
        frames: the frames at both ends; see `initial_frames` for unknown ones.
        on_progress: called with the current step.

    Raises BadMeasurement and Untrustworthy.
    """
    check_postures(find_postures(observations.joints, arm.slides, noise=0.0))
    on_progress("geometry")
    model = ErrorModel(arm, OFFSETS, frames)
    estimate = identify_by_consensus(model, observations)
    counted = estimate.weights >= OUTLYING
    geometry = Calibration(model, estimate)
    check_estimate(geometry, observations)
    check_links(geometry)
    postures = check_postures(find_postures(observations.joints, arm.slides, estimate.noise[0]))

    def identified(
        candidates: Sequence[JointTerms], rows: np.ndarray, start: Identification | None = None
    ) -> list[Calibration]:
        terms = [held(terms, postures.still) for terms in candidates]
        weights = counted[rows].astype(float)
        return calibrations(arm, terms, observations[rows], frames, start, weights)

    every = np.ones(len(observations), dtype=bool)
    nothing, *candidates = identified([NO_ERRORS, *CANDIDATES], every)
    on_progress("errors beyond geometry")
    best = choose(candidates)
    if not candidates[best].estimate.converged:  # a model of many parameters needs more steps
        candidates = identified(CANDIDATES, every, candidates[best].estimate)
        best = choose(candidates)
    full = {NOTHING: nothing, GEOMETRIC: candidates[0]}
    hybrid = with_pattern(candidates[best], observations)
    richer = best > 0 or hybrid.pattern is not None
    unsettled = richer and not hybrid.estimate.converged
    if richer and not unsettled:
        full[HYBRID] = hybrid

    def without(rows: np.ndarray) -> dict[str, Calibration]:
        # a richer model than the one chosen for all rows is not tried on fewer rows
        tried = [NO_ERRORS, *CANDIDATES[: 1 + best * (HYBRID in full)]]
        none, *others = identified(tried, ~rows)
        found = {NOTHING: none, GEOMETRIC: others[0], HYBRID: others[choose(others)]}
        if hybrid.pattern is not None:
            process = hybrid.pattern.hyperparameters
            found[HYBRID] = with_pattern(found[HYBRID], observations[~rows], process)
        return {kind: found[kind] for kind in full}

    unseen = {kind: calibration.unseen(observations) for kind, calibration in full.items()}
    held_out, lost = {}, {}
    for way, divide in zip(WAYS, (blocks, random_folds), strict=True):
        on_progress(f"errors {way}")
        folds = divide(observations, postures)
        residuals = {kind: np.empty((len(folds), 3 * observations.kinds)) for kind in full}
        for fold in np.unique(folds):
            out = folds == fold
            for kind, calibration in without(out).items():
                residuals[kind][out] = calibration.residuals(observations[out])
        held_out[way] = {
            kind: HeldOut(of_kind, folds, observations.optics, unseen[kind])
            for kind, of_kind in residuals.items()
        }
        lost[way] = _lost(candidates[0].model, observations, folds)
    full.setdefault(HYBRID, full[GEOMETRIC])  # no errors beyond geometry
    for errors in held_out.values():
        errors.setdefault(HYBRID, errors[GEOMETRIC])
    return Validation(held_out, postures, counted, lost, full, unsettled)


def _lost(model: ErrorModel, observations: Observations, folds: np.ndarray) -> np.ndarray:
    """Whether rows (n,) are in a fold that alone determines some direction of the geometry."""
    unseen = Unseen(model, observations).directions.shape[1]
    decisive = [
        fold
        for fold in np.unique(folds)
        if Unseen(model, observations[folds != fold]).directions.shape[1] > unseen
    ]
    return np.isin(folds, decisive)
