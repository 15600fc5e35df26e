"""Cross-validated errors of calibrations, and which calibration to use.

The residuals of the fit are no measure: a Gaussian process interpolates.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from recalib.identification.calibration import Calibration, calibrate, calibrate_again
from recalib.identification.checks.diagnostics import check_estimate, check_links, check_postures
from recalib.identification.checks.postures import Postures, find_postures
from recalib.identification.consensus import identify_by_consensus
from recalib.identification.estimation import LEAST_NOISE, identify
from recalib.identification.held_out import HeldOut, blocks, hold_out, random_folds
from recalib.identification.model.error_model import (
    JOINT_ERRORS,
    JOINT_WAVES,
    NO_ERRORS,
    OFFSETS,
    ErrorModel,
    held,
)
from recalib.identification.model.frames import Frames
from recalib.identification.model.observations import Observations
from recalib.nominal.kinematics import Arm

NOTHING, GEOMETRIC, HYBRID = KINDS = "nothing", "geometric", "hybrid"  # the simplest first
# Of errors away from what was measured, and among it. The first is what a calibration is worth.
BLOCKWISE, RANDOM = WAYS = "in blocks", "at random"
OUTLYING = 0.1  # the weight of a row below which it is grossly off: ten standard deviations
# The joint terms that each may have, the fewest first.
CANDIDATES = {
    NOTHING: (NO_ERRORS,),
    GEOMETRIC: (OFFSETS,),
    HYBRID: (OFFSETS, JOINT_ERRORS, JOINT_WAVES),
}
SURE = 2.0  # standard errors by which something richer has to be better, to be used


@dataclass(frozen=True)
class Validation:
    """Errors on rows that were not learned from.

    Attributes:
        held_out: by way of folding and by what is done. Where frames are unknown, those of the
            nominal arm are identified, too, and nothing else is.
        postures: in which all rows are.
        counted: (n,) whether a row counts for the choice and in errors; others are grossly off.
        chosen: what is best done: nothing, geometric or hybrid.
        full: the calibrations from all rows.
        unsettled: whether there was more than geometry, but its identification did not converge.
    """

    held_out: Mapping[str, Mapping[str, HeldOut]]
    postures: Postures
    counted: np.ndarray
    chosen: str
    full: Mapping[str, Calibration]
    unsettled: bool

    @property
    def calibration(self) -> Calibration:
        """The one that is chosen."""
        return self.full[self.chosen]

    def errors(self, way: str, kind: str) -> np.ndarray:
        """(n, 1) m or (n, 2) m and rad: how far off, and how far turned."""
        return self.held_out[way][kind].errors

    def mean_error(self, way: str, kind: str) -> float:
        """Of position [m], over the rows that count."""
        return float(self.errors(way, kind)[self.counted, 0].mean())

    @property
    def radius(self) -> float:
        """Within how much [m] of their predictions 95 % of measured positions lie.

        For the calibration that is chosen, also in postures away from those measured.
        """
        return self.held_out[BLOCKWISE][self.chosen][self.counted].radius()

    def coverage(self, way: str) -> float:
        """The part of held-out positions that lie within such a radius, made without them."""
        return self.held_out[way][self.chosen][self.counted].coverage()


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
        on_progress: called with what is being done.

    Raises BadMeasurement and Untrustworthy.
    """
    check_postures(find_postures(observations.joints, arm.slides, noise=0.0))
    on_progress("geometry")
    model = ErrorModel(arm, OFFSETS, frames)
    estimate = identify_by_consensus(model, observations)
    counted = estimate.weights >= OUTLYING
    geometry = Calibration(model, estimate)
    check_estimate(geometry, observations, counted)
    check_links(geometry)
    postures = check_postures(find_postures(observations.joints, arm.slides, estimate.noise[0]))
    candidates = {
        kind: [held(terms, postures.still) for terms in options]
        for kind, options in CANDIDATES.items()
    }
    weights = counted.astype(float)
    full = {}
    for kind in (NOTHING, GEOMETRIC):
        (terms,) = candidates[kind]
        model = ErrorModel(arm, terms, frames)
        full[kind] = Calibration(model, identify(model, observations, weights=weights))
    on_progress("errors beyond geometry")
    hybrid = calibrate(arm, candidates[HYBRID], observations, frames, weights=weights)
    if not hybrid.estimate.converged:  # it has many parameters, and goes on from there
        hybrid = calibrate(arm, candidates[HYBRID], observations, frames, hybrid, weights)
    richer = hybrid.pattern is not None or hybrid.model.names != full[GEOMETRIC].model.names
    unsettled = richer and not hybrid.estimate.converged
    if richer and not unsettled:
        full[HYBRID] = hybrid
    held_out = {}
    for way, divide in zip(WAYS, (blocks, random_folds), strict=True):
        folds = divide(observations, postures)
        on_progress(f"errors {way}")
        fits = {kind: partial(calibrate_again, full[kind], candidates[kind]) for kind in full}
        held_out[way] = {
            kind: hold_out(fit, observations, weights, folds) for kind, fit in fits.items()
        }
    chosen = _choice(held_out, counted, postures)
    full.setdefault(HYBRID, full[GEOMETRIC])  # there was nothing but geometry
    for errors in held_out.values():
        errors.setdefault(HYBRID, errors[GEOMETRIC])
    return Validation(held_out, postures, counted, chosen, full, unsettled)


def _choice(
    held_out: Mapping[str, Mapping[str, HeldOut]], counted: np.ndarray, postures: Postures
) -> str:
    """The simplest that nothing beats for sure, on postures held out in both ways."""
    _, own = np.unique(postures.numbers[counted], return_inverse=True)
    losses = {
        kind: np.mean([held_out[way][kind][counted].losses for way in WAYS], axis=0)
        for kind in held_out[RANDOM]
    }
    best, *richer = losses
    for kind in richer:
        # rows of one posture err alike: they are one gain
        gains = np.bincount(own, losses[best] - losses[kind]) / np.bincount(own)
        if gains.mean() > max(SURE * gains.std(ddof=1) / np.sqrt(len(gains)), LEAST_NOISE):
            best = kind
    return best
