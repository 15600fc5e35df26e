"""Faults in the sequence of rows: poses that lag behind the joints, a drift, a jump, a slip.

Rows in the order of measurement show such faults in their residuals. Each fault is modelled by
parameters in addition to those of the arm: the delay of all poses as a part of a step; a motion of
the instrument relative to the base, over time or from some row on; or one of a target on the tool.
Of several cameras, each may have faults of its own. A fault that no arm could explain instead, and
that is too large for chance, is reported.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.linalg
from scipy.special import fdtrc

from recalib.identification.calibration import Calibration
from recalib.identification.error_model import JOINT_ERRORS, ErrorModel
from recalib.identification.linearisation import Linearisation, displacements
from recalib.identification.observations import Observations
from recalib.identification.postures import find_postures

LAG, DRIFT, JUMP, SLIP = "lag", "drift", "jump", "slip"
CHANCE = 1e-6  # with which what is named would be there by chance, were all residuals noise
SHARE = 0.15  # of the squares of residuals; those of real arms are more than noise
MOST = 3  # faults at once
ENDS = 10  # rows on either side of a jump
SMALL = 1e-3  # of the typical step: for slopes


@dataclass(frozen=True)
class Fault:
    """Something that rows show by their order.

    Attributes:
        kind: lag, drift, jump (of the instrument) or slip (of a target).
        size: of a lag, by how many seconds poses are late, or, of rows without times, by what part
            of the step to each; otherwise m, by how much the instrument moves against the base,
            from the first row to the last or at once, or the target against the tool.
        row: from 0 in its series, the first one after a jump or a slip.
        turn: rad, that goes with the size.
        sight: its number, or that of the first row of the series.
    """

    kind: str
    size: float
    row: int = 0
    turn: float = 0.0
    sight: int = 0


def faults(geometry: Calibration, observations: Observations, counted: np.ndarray) -> list[Fault]:
    """What the rows of each series show by their order, if they were measured in that order.

    Args:
        geometry: what was identified from them.
        counted: (n,) whether a row is not grossly off.
    """
    model = ErrorModel(geometry.model.nominal, JOINT_ERRORS, geometry.model.frames)
    parameters, estimate = np.zeros_like(model.deviations), geometry.estimate
    parameters[: len(estimate.parameters)] = estimate.parameters
    terms = model.terms(observations.joints)
    linear = Linearisation(model, parameters / model.deviations, observations, terms)
    weights = np.sqrt(estimate.weights * counted)[:, None] / np.repeat(estimate.noise, 3)
    residuals = np.concatenate([*linear.residuals], axis=1) * weights
    arm = np.concatenate([*linear.jacobians], axis=1) * weights[..., None]
    times = np.arange(len(observations)) if observations.times is None else observations.times
    here = geometry.predict(observations.joints, observations.targets)
    seen = slice(3 * observations.kinds)  # nobody sees how a point is turned about itself
    moved = observations.whitened(_moved(here, observations.series)[:, seen])
    slipped = observations.whitened(_slipped(here)[:, seen, seen])
    moved, slipped = (columns * weights[..., None] for columns in (moved, slipped))
    slides = model.nominal.slides
    postures = find_postures(observations.joints, slides, estimate.noise[0])
    alike = len(observations) / len(postures)
    candidates = []
    for number in np.unique(observations.series):
        series = np.flatnonzero(observations.series == number)
        first = int(observations.targets[series[0]])
        its, clock = observations[series], times[series]
        late = its.whitened(_late(geometry, its, clock))[..., None] * weights[series, :, None]
        drifted = moved[series] * ((clock - clock[0]) / np.ptp(clock))[:, None, None]
        candidates += [
            _Candidate(LAG, first, series, series, late),
            _Candidate(DRIFT, first, series, series, drifted),
            _Candidate(JUMP, first, series, series, moved[series], ENDS),
        ]
        for sight in np.unique(its.targets):
            rows = series[its.targets == sight]
            candidates.append(_Candidate(SLIP, int(sight), series, rows, slipped[rows], ENDS))
    found: list[Fault] = []
    while len(found) < MOST:  # the plainest first, then what it does not explain
        rest = _Unexplained(residuals, arm, alike)
        tried = [(*rest.plainest(candidate), candidate) for candidate in candidates]
        share, after, by, best = max(tried, key=lambda one: one[0])
        if share < SHARE:
            break
        kind, sight, series, rows, columns, _ = best
        size, turn = by[0] if kind == LAG else np.linalg.norm(by[:3]), np.linalg.norm(by[3:])
        row = int(np.searchsorted(series, rows[after]))
        found.append(Fault(kind, float(size), row, float(turn), sight))
        further = np.zeros((*residuals.shape, columns.shape[-1]))
        further[rows[after:]] = columns[after:]
        arm = np.concatenate([arm, further], axis=2)
    return found


class _Candidate(NamedTuple):
    """A fault that there may be.

    Attributes:
        kind, sight: of the fault.
        series: (s,) numbers of the rows of its series.
        rows: (m,) numbers of the rows that it concerns, in their order.
        columns: (m, k, c) slopes of their residuals by the fault's parameters.
        ends: so many of them at least are on either side of where it begins; it does with the first
            unless given.
    """

    kind: str
    sight: int
    series: np.ndarray
    rows: np.ndarray
    columns: np.ndarray
    ends: int = 0


class _Unexplained:
    """What an arm does not explain of weighted rows, and what further parameters would.

    Args:
        residuals: (n, k) over their noise.
        arm: (n, k, P) their slopes by parameters over their deviations.
        alike: rows to a posture. What no model explains is the same in all of them, so they are
            one where chance is asked for.
    """

    def __init__(self, residuals: np.ndarray, arm: np.ndarray, alike: float):
        self._residuals, self._arm, self._alike = residuals, arm, alike
        self._gradient = np.einsum("nkp,nk->p", arm, residuals)
        rows = arm.reshape(-1, arm.shape[-1])
        information = rows.T @ rows
        self._factor = scipy.linalg.cho_factor(information + np.eye(len(information)))
        self._squares = np.sum(residuals**2) - self._gradient @ self._solve(self._gradient)
        self._free = np.count_nonzero(residuals) - np.trace(self._solve(information))

    def plainest(self, candidate: _Candidate) -> tuple[float, int, np.ndarray]:
        """A fault's share of the unexplained squares, 0 where that may be chance.

        Returns also with which of its rows it begins, and its parameters (c,).
        """
        its, columns, ends = candidate.rows, candidate.columns, candidate.ends
        products = (
            np.einsum("nkc,nkd->ncd", columns, columns),
            np.einsum("nkc,nkp->ncp", columns, self._arm[its]),
            np.einsum("nkc,nk->nc", columns, self._residuals[its]),
        )
        rows = np.arange(ends, len(columns) - ends + 1) if ends else np.zeros(1, int)
        if not len(rows) or self._free <= columns.shape[-1]:
            return 0.0, 0, np.zeros(columns.shape[-1])
        own, across, gradient = (np.cumsum(part[::-1], axis=0)[::-1][rows] for part in products)
        absorbed = self._solve(across.reshape(-1, across.shape[-1]).T).T.reshape(across.shape)
        own = own - absorbed @ across.swapaxes(1, 2)
        gradient = gradient - absorbed @ self._gradient
        found = (np.linalg.pinv(own, hermitian=True) @ gradient[..., None])[..., 0]
        gains = np.sum(found * gradient, axis=1)
        best, count = int(gains.argmax()), columns.shape[-1]
        gain, free = gains[best], (self._free - count) / self._alike
        ratio = gain / count / (self._squares - gain) * free
        plain = fdtrc(count, free, ratio) * len(rows) < CHANCE
        return gain / self._squares if plain else 0.0, int(rows[best]), found[best]

    def _solve(self, pulls: np.ndarray) -> np.ndarray:
        return scipy.linalg.cho_solve(self._factor, pulls)


def _late(geometry: Calibration, observations: Observations, times: np.ndarray) -> np.ndarray:
    """How targets go back with time (n, k) [m, rad], at the speed of the step to each row."""
    times, first, numbers = np.unique(times, return_index=True, return_inverse=True)
    lasted = np.diff(times)  # of rows at one time all are as fast
    speeds = np.diff(observations.joints[first], axis=0) / lasted[:, None]
    speeds = np.concatenate([0 * speeds[:1], speeds])[numbers]
    small = SMALL * np.median(lasted)
    here = geometry.predict(observations.joints, observations.targets)
    before = geometry.predict(observations.joints - small * speeds, observations.targets)
    return displacements(here, before)[:, : 3 * observations.kinds] / small


def _moved(poses: np.ndarray, series: np.ndarray) -> np.ndarray:
    """What moves of the instrument by 1 m and 1 rad do to poses (n, 6, 6), about the middle."""
    columns = np.zeros((len(poses), 6, 6))
    columns[:] = np.eye(6)
    for number in np.unique(series):
        places = poses[series == number, :3, 3]
        levers = (places - places.mean(axis=0))[:, None]
        columns[series == number, :3, 3:] = np.cross(np.eye(3), levers).swapaxes(1, 2)
    return columns


def _slipped(poses: np.ndarray) -> np.ndarray:
    """What moves of the target by 1 m and 1 rad, along its own axes, do to poses (n, 6, 6)."""
    columns = np.zeros((len(poses), 6, 6))
    columns[:, :3, :3] = columns[:, 3:, 3:] = poses[:, :3, :3]
    return columns
