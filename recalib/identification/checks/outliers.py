"""Exchanged rows among the outliers."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from recalib.identification.calibration import Calibration
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.model.observations import Observations

NEAR = 8.0  # standard deviations within which a row fits another's joints
MOST = 300  # outliers to compare: memory grows with their square


class Exchanged(NamedTuple):
    """Numbers (k,), from 0, of rows, and of the rows whose joints fit their measurements."""

    rows: np.ndarray
    others: np.ndarray


def exchanged(geometry: Calibration, observations: Observations) -> Exchanged | None:
    """Outliers whose measurements fit the joints of other outliers; None if no such rows exist."""
    rows = np.flatnonzero(geometry.estimate.weights < DOUBTFUL)[:MOST]
    count = len(rows)
    if count < 2 or observations.measured is None:  # balls in sockets have no positions
        return None
    pairs, others = observations[np.repeat(rows, count)], observations[np.tile(rows, count)]
    pairs = replace(pairs, joints=others.joints, targets=others.targets)
    residuals = pairs.whitened(geometry.residuals(pairs)) / np.repeat(geometry.estimate.noise, 3)
    gaps = np.linalg.norm(residuals, axis=1).reshape(count, count) / np.sqrt(pairs.kinds)
    best = gaps.argmin(axis=1)
    fit = (gaps.min(axis=1) < NEAR) & (best != np.arange(count))
    return Exchanged(rows[fit], rows[best[fit]]) if fit.any() else None
