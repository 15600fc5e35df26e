"""Cross-validated errors of calibrations, and which calibration to use.

The residuals of the fit do not show it: a Gaussian process interpolates.
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
# Of errors on postures away from those measured, and among them. The first say what a calibration
# is worth.
BLOCKWISE, RANDOM = WAYS = "in blocks", "at random"
OUTLYING = 0.1  # the weight of a row below which it is grossly off: ten standard deviations
CANDIDATES = OFFSETS, JOINT_ERRORS, JOINT_WAVES  # the joint terms that there may be
SURE = 2.0  # standard errors by which something richer has to be better, to be used


@dataclass(frozen=True)
class Validation:
    """Held-out errors, and the calibrations from all rows.

    Attributes:
        held_out: by way of folding and by what is corrected. If frames are unknown, the nominal
            arm's are identified, too, and nothing else is.
        postures: of all rows.
        counted: (n,) whether a row counts for the choice and in errors; others are grossly off.
        lost: by way of folding, (n,) whether the part of a row determines what no other rows do:
            without it a direction of the geometry is not identifiable, and errors show only that.
        full: the calibrations from all rows.
        unsettled: whether there was more than geometry, but its identification did not converge.
    """

    held_out: Mapping[str, Mapping[str, HeldOut]]
    postures: Postures
    counted: np.ndarray
    lost: Mapping[str, np.ndarray]
    full: Mapping[str, Calibration]
    unsettled: bool

    @cached_property
    def chosen(self) -> str:
        """The simplest of nothing, geometric and hybrid that nothing richer beats for sure.

        On postures away from those learned from.
        """
        judged = self.judged(BLOCKWISE)
        _, own = np.unique(self.postures.numbers[judged], return_inverse=True)
        losses = {kind: self.held_out[BLOCKWISE][kind][judged].losses for kind in KINDS}
        best, *richer = KINDS
        for kind in richer:
            # rows of one posture err alike: they are one gain
            gains = np.bincount(own, losses[best] - losses[kind]) / np.bincount(own)
            if gains.mean() > max(SURE * gains.std(ddof=1) / np.sqrt(len(gains)), LEAST_NOISE):
                best = kind
        return best

    @property
    def calibration(self) -> Calibration:
        """The one that is chosen."""
        return self.full[self.chosen]

    def judged(self, way: str) -> np.ndarray:
        """Rows (n,) whose errors count: all but outliers and rows that are `lost`.

        If hardly any part is left, all but outliers count.
        """
        judged = self.counted & ~self.lost[way]
        parts = self.held_out[way][NOTHING].folds[judged]
        return judged if len(np.unique(parts)) > 1 else self.counted

    def held_out_by(self, way: str, kind: str) -> HeldOut:
        """The rows whose errors count."""
        return self.held_out[way][kind][self.judged(way)]

    def mean_error(self, way: str, kind: str) -> float:
        """Of position [m], over the rows that count."""
        return float(self.held_out_by(way, kind).errors[:, 0].mean())

    @property
    def radius(self) -> float:
        """Within how much [m] of their predictions 95 % of measured positions lie.

        For the calibration that is chosen, also in postures away from those measured.
        """
        return self.held_out_by(BLOCKWISE, self.chosen).radius()

    def coverage(self, way: str) -> float:
        """The part of held-out positions that lie within such a radius, made without them."""
        return self.held_out_by(way, self.chosen).coverage()


def validate(
    arm: Arm,
    observations: Observations,
    frames: Frames | None = None,
    on_progress: Callable[[str], None] = lambda text: None,
) -> Validation:
    """Calibrate an arm in several ways, and say what each is worth.

    The hybrid is geometry with joint errors and a Gaussian process of the residuals, as far as all
    rows show any. Where rows are held out, all is identified and chosen anew but how smooth the
    process is. A joint that stood still has no errors: what holds it has them.

    Args:
        frames: at both ends; see `initial_frames` for those that are unknown.
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
    if not candidates[best].estimate.converged:  # it has many parameters, and goes on from there
        candidates = identified(CANDIDATES, every, candidates[best].estimate)
        best = choose(candidates)
    full = {NOTHING: nothing, GEOMETRIC: candidates[0]}
    hybrid = with_pattern(candidates[best], observations)
    richer = best > 0 or hybrid.pattern is not None
    unsettled = richer and not hybrid.estimate.converged
    if richer and not unsettled:
        full[HYBRID] = hybrid

    def without(rows: np.ndarray) -> dict[str, Calibration]:
        # a model that is not chosen for all rows is not tried on fewer
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
            kind: HeldOut(every, folds, observations.optics, unseen[kind])
            for kind, every in residuals.items()
        }
        lost[way] = _lost(candidates[0].model, observations, folds)
    full.setdefault(HYBRID, full[GEOMETRIC])  # there was nothing but geometry
    for errors in held_out.values():
        errors.setdefault(HYBRID, errors[GEOMETRIC])
    return Validation(held_out, postures, counted, lost, full, unsettled)


def _lost(model: ErrorModel, observations: Observations, folds: np.ndarray) -> np.ndarray:
    """Whether rows (n,) are in a part without which more directions are open than with it."""
    opened = Unseen(model, observations).directions.shape[1]
    parts = [
        fold
        for fold in np.unique(folds)
        if Unseen(model, observations[folds != fold]).directions.shape[1] > opened
    ]
    return np.isin(folds, parts)
