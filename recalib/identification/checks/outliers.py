"""Patterns in outliers: exchanged rows, and rows measured with the instrument displaced."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from recalib.identification.calibration import Calibration
from recalib.identification.estimation import DOUBTFUL
from recalib.identification.model.frames import nearest_rotation
from recalib.identification.model.observations import Observations

NEAR = 8.0  # standard deviations along an axis within which a row fits another's prediction
FEWEST, REST = 5, 0.3  # successive rows; the fraction of their errors that one motion may leave
MOST = 1000  # outliers to compare: memory grows with their square


class Exchanged(NamedTuple):
    """Numbers (k,), from 0, of rows, and of the rows whose joints fit their measurements."""

    rows: np.ndarray
    others: np.ndarray


class Displaced(NamedTuple):
    """Rows, from 0, whose measurements a single motion [m, rad] of the instrument explains."""

    first: int
    last: int
    shift: float
    turn: float


def exchanged(geometry: Calibration, observations: Observations) -> Exchanged | None:
    """Outliers whose measurements fit the joints of other outliers; None if no such rows exist."""
    rows = _outliers(geometry, observations)[:MOST]
    if len(rows) < 2:
        return None
    gaps = cdist(observations[rows].positions, _predicted(geometry, observations[rows]))
    best = gaps.argmin(axis=1)
    fit = gaps[np.arange(len(rows)), best] < NEAR * geometry.estimate.noise[0]
    fit &= best != np.arange(len(rows))
    return Exchanged(rows[fit], rows[best[fit]]) if fit.any() else None


def displaced(geometry: Calibration, observations: Observations) -> list[Displaced]:
    """Runs of equally displaced outliers between other rows; a run at either end is a jump."""
    found, outliers = [], _outliers(geometry, observations)
    for run in np.split(outliers, np.flatnonzero(np.diff(outliers) > 1) + 1):
        ends = [row for row in (*(run[:1] - 1), *(run[-1:] + 1)) if 0 <= row < len(observations)]
        if len(run) < FEWEST or np.ptp(observations.series[[*run, *ends]]) or len(ends) < 2:
            continue
        rows = observations[run]
        before, after = _predicted(geometry, rows), rows.positions
        middle = before.mean(axis=0)
        turn = nearest_rotation((after - after.mean(axis=0)).T @ (before - middle))
        moved = (before - middle) @ turn.T + after.mean(axis=0)
        if np.linalg.norm(after - moved) < REST * np.linalg.norm(after - before):
            angle = np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))
            shift = float(np.linalg.norm(after.mean(axis=0) - middle))
            found.append(Displaced(int(run[0]), int(run[-1]), shift, float(angle)))
    return found


def _outliers(geometry: Calibration, observations: Observations) -> np.ndarray:
    """The numbers (k,) of outliers; none for balls in sockets, which have no positions."""
    if observations.measured is None:
        return np.zeros(0, dtype=int)
    return np.flatnonzero(geometry.estimate.weights < DOUBTFUL)


def _predicted(geometry: Calibration, rows: Observations) -> np.ndarray:
    return geometry.predict(rows.joints, rows.targets)[:, :3, 3]
