"""Where cameras and boards are if the arm is taken as right, as in ordinary hand-eye calibration.

It is compared with a calibration of the arm, so all else is as there: the same lens and print, and
rows weighed as they deserve. Here what a row is off by is mostly the arm's error, of which a camera
sees no direction better than another.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pinocchio as pin

from recalib.identification.calibration import Calibration
from recalib.identification.checks.repeatability import weigh
from recalib.identification.estimation import identify
from recalib.identification.held_out import HeldOut, hold_out
from recalib.identification.model.error_model import NO_ERRORS, ErrorModel
from recalib.identification.model.frames import HELD
from recalib.identification.model.observations import Observations
from recalib.identification.validation import NOTHING

# rad by which such an arm does not come where its description says, from a good one to a bent one
ERRORS = 3e-4, 1e-3, 3e-3, 1e-2, 3e-2


def arm_as_right(
    calibration: Calibration, observations: Observations, folds: Mapping[str, np.ndarray]
) -> tuple[Calibration, dict[str, HeldOut]]:
    """The frames by rows of cameras with the nominal arm, and errors by way of folding.

    Args:
        calibration: of the arm, by the same rows.
        folds: (n,) the number of the part in which a row is held out, by way.

    Raises BadMeasurement, as `identify`.
    """
    optics, measured = observations.optics, observations.measured
    assert optics is not None and measured is not None
    model = ErrorModel(calibration.model.nominal, NO_ERRORS, calibration.model.frames)
    model.deviations[model.optics_columns] = HELD
    found = calibration.estimate.parameters[calibration.model.optics_columns]
    moved = measured.copy()
    for pose, by in zip(moved, optics.slopes @ found, strict=True):
        pose[:3, 3] += by[:3]
        pose[:3, :3] = pin.exp3(by[3:]) @ pose[:3, :3]
    rows = weigh(model, replace(observations, measured=moved), ERRORS)

    def fit(some: np.ndarray) -> Calibration:
        return Calibration(model, identify(model, rows[some]))

    def without(held: np.ndarray) -> dict[str, Calibration]:
        return {NOTHING: fit(~held)}

    held_out = {way: hold_out(without, rows, parts)[NOTHING] for way, parts in folds.items()}
    return fit(np.ones(len(rows), dtype=bool)), held_out
