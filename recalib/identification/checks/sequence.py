"""Faults in the sequence of rows: poses that lag behind the joints, a drift, a jump, a slip.

The residuals of rows in the order of measurement show such faults. Parameters in addition to those
of the arm model each fault: the delay of all poses as a fraction of a step; the growth of an arm
that warms up; a motion of the instrument relative to the base, over time or from some row on; or a
motion of a target on the tool. Each of several cameras may have faults of its own. A fault is
reported if no arm could explain it instead and if it is too large for chance. All rows take part,
even those with large residuals, which all rows after a jump have. But no single row decides.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.linalg
from scipy.special import fdtrc

from recalib.identification.calibration import Calibration
from recalib.identification.checks.postures import find_postures
from recalib.identification.estimation import identify
from recalib.identification.model.error_model import JOINT_ERRORS, ErrorModel
from recalib.identification.model.linearisation import Linearisation, crosses, displacements
from recalib.identification.model.observations import Observations

LAG, DRIFT, GROWTH, JUMP, SLIP = "lag", "drift", "growth", "jump", "slip"
CHANCE = 1e-6  # the probability of a reported fault if all residuals were noise
SHARE = 0.15  # the least share of the squared residuals: a real arm's residuals are more than noise
MOST = 3  # faults at once
ENDS = 5  # the least number of rows on either side of a jump
# In deviations of the noise. Beyond it, the residual of a row counts and not its square. If this
# reveals no fault, for instance because of gross outliers, such a row hardly counts at all.
FAR = 4.0
CUTS = 60  # places at which something may move or be moved back
ALIKE = 0.8  # of the squared residuals in between: a motion for some time explains more
SMALL = 1e-3  # fraction of the typical step for finite differences


@dataclass(frozen=True)
class Fault:
    """A fault that the order of rows reveals.

    Attributes:
        kind: lag, drift, growth (of the arm), jump (of the instrument) or slip (of a target).
        size: for a lag, the delay of poses in seconds, or as a fraction of the step to each row if
            rows have no times; for growth, the relative growth from the first row to the last;
            otherwise the motion [m] of the instrument relative to the base, from the first row to
            the last or at once, or of the target relative to the tool.
        row: the first row, from 0 in its series, after a jump or a slip.
        back: the first row that is as before again; 0 if there is none.
        turn: rad, the rotation that belongs to the size.
        sight: the number of this row's sight.
    """

    kind: str
    size: float
    row: int = 0
    turn: float = 0.0
    sight: int = 0
    back: int = 0


def faults(geometry: Calibration, observations: Observations) -> list[Fault]:
    """The faults in each series of rows, from which the geometry was identified.

    A lag distorts the identified arm, so its residuals resemble other faults. If a lag is the most
    significant fault, the other faults are sought after its removal.
    """
    found = _faults(geometry, observations, 1) or _faults(geometry, observations, 2)
    if len(found) < 2 or found[0].kind != LAG:
        return found
    # move the joints back to the times at which the poses were measured
    lag, joints, series = found[0], observations.joints.copy(), observations.series
    rows = series == series[observations.targets == lag.sight][0]
    joints[rows] -= lag.size * _speeds(joints[rows], _times(observations)[rows])
    punctual = replace(observations, joints=joints)
    again = identify(geometry.model, punctual, geometry.estimate, geometry.estimate.weights)
    others = _faults(replace(geometry, estimate=again), punctual, 1)
    others = [fault for fault in others if (fault.kind, fault.sight) != (LAG, lag.sight)]
    return [lag, *others][:MOST]


def _faults(geometry: Calibration, observations: Observations, power: int) -> list[Fault]:
    """The faults by one linearisation, with weights that fall by a power of the residual."""
    residuals, arm, weights, model = slopes_of(geometry, observations, power)
    estimate = geometry.estimate
    postures = find_postures(observations.joints, model.nominal.slides, estimate.noise[0])
    redundancy = len(observations) / len(postures)
    candidates = [
        one._replace(columns=one.columns * weights[one.rows, :, None])
        for one in _candidates(geometry, observations)
    ]
    found: list[Fault] = []
    while len(found) < MOST:  # the most significant fault first, then those that remain next to it
        rest = Unexplained(residuals, arm, redundancy)
        tried = [(*rest.strongest(candidate), candidate) for candidate in candidates]
        share, (first, last), step, candidate = max(tried, key=lambda one: one[0])
        if share < SHARE:
            break
        size = step[0] if len(step) == 1 else np.linalg.norm(step[:3])
        turn = np.linalg.norm(step[3:])
        kind, rows, columns, _ = candidate
        series = np.cumsum(observations.series == observations.series[rows[first]]) - 1
        back = int(series[rows[last]]) if last < len(rows) else 0
        row, sight = int(series[rows[first]]), int(observations.targets[rows[first]])
        found.append(Fault(kind, float(size), row, float(turn), sight, back))
        further = np.zeros((*residuals.shape, columns.shape[-1]))
        further[rows[first:last]] = columns[first:last]
        arm = np.concatenate([arm, further], axis=2)
    return found


class Slopes(NamedTuple):
    """Weighted residuals and their slopes.

    Attributes:
        residuals: (n, k) over their noise.
        arm: (n, k, P) slopes of the residuals by the model's parameters over their deviations.
        weights: (n, k) of both.
        model: the error model, geometry with joint errors.
    """

    residuals: np.ndarray
    arm: np.ndarray
    weights: np.ndarray
    model: ErrorModel


def slopes_of(geometry: Calibration, observations: Observations, power: int) -> Slopes:
    """The slopes of all rows; large residuals have weights that fall by a power of the residual."""
    model = ErrorModel(geometry.model.nominal, JOINT_ERRORS, geometry.model.frames)
    parameters, estimate = np.zeros_like(model.deviations), geometry.estimate
    parameters[: len(estimate.parameters)] = estimate.parameters
    linear = Linearisation(model, parameters / model.deviations, observations)
    residuals = np.concatenate([*linear.residuals], axis=1) / np.repeat(estimate.noise, 3)
    lengths = np.linalg.norm(residuals, axis=1, keepdims=True)
    weights = np.sqrt(FAR / np.maximum(lengths, FAR)) ** power
    residuals, weights = residuals * weights, weights / np.repeat(estimate.noise, 3)
    arm = np.concatenate([*linear.jacobians], axis=1) * weights[..., None]
    return Slopes(residuals, arm, weights, model)


class Candidate(NamedTuple):
    """A possible fault.

    Attributes:
        kind: the kind of fault.
        rows: (m,) the numbers of the affected rows, in the order of measurement.
        columns: (m, k, c) slopes of these rows' residuals by the fault's parameters.
        windows: (w, 2) the first row, and the one after the last, of each part that may have it;
            None: all rows have it.
    """

    kind: str
    rows: np.ndarray
    columns: np.ndarray
    windows: np.ndarray | None = None


def jumps(count: int) -> np.ndarray:
    """All windows from some row to the last, with enough rows on both sides of the first."""
    firsts = np.arange(ENDS, count - ENDS + 1)
    return np.stack([firsts, np.full(len(firsts), count)], axis=1)


def _excursions(count: int) -> np.ndarray:
    """Windows of enough rows between other rows, from and to at most `CUTS` places."""
    cuts = np.unique(np.linspace(1, count - 1, CUTS).astype(int))
    pairs = np.stack(np.meshgrid(cuts, cuts), axis=-1).reshape(-1, 2)
    length = pairs[:, 1] - pairs[:, 0]
    return pairs[(length >= ENDS) & (length <= count - 2 * ENDS)]


def _candidates(geometry: Calibration, observations: Observations) -> Iterator[Candidate]:
    """All candidates, with slopes of whitened residuals."""
    times = _times(observations)
    poses = geometry.predict(observations.joints, observations.targets)
    instruments, targets = geometry.model.frames.sights[observations.targets].T
    known = slice(3 * observations.kinds)  # the rotation of a point is not measured
    moved = observations.whitened(_moved(poses, instruments)[:, known])
    grown = np.zeros((len(poses), 6, 1))
    grown[:, :3, 0] = poses[:, :3, 3] - geometry.frames.bases[instruments, :3, 3]
    grown = observations.whitened(grown[:, known])
    slipped = np.zeros((len(poses), 6, 6))  # along the target's own axes
    slipped[:, :3, :3] = slipped[:, 3:, 3:] = poses[:, :3, :3]
    slipped = observations.whitened(slipped[:, known, known])
    passed = np.zeros(len(observations))
    for number in np.unique(observations.series):
        rows = np.flatnonzero(observations.series == number)
        part, clock = observations[rows], times[rows]
        if clock[0] == clock[-1]:  # a camera with one picture cannot show a lag or a drift
            continue
        passed[rows] = (clock - clock[0]) / np.ptp(clock)
        yield Candidate(LAG, rows, part.whitened(_late(geometry, part, clock))[..., None])
        yield Candidate(DRIFT, rows, moved[rows] * passed[rows, None, None])
        yield Candidate(GROWTH, rows, grown[rows] * passed[rows, None, None])
    along = passed if observations.times is None else times
    for kind, numbers, columns in ((JUMP, instruments, moved), (SLIP, targets, slipped)):
        for number in np.unique(numbers):
            for rows in _orders(np.flatnonzero(numbers == number), observations.series, along):
                for windows in jumps(len(rows)), _excursions(len(rows)):
                    yield Candidate(kind, rows, columns[rows], windows)


def _orders(rows: np.ndarray, series: np.ndarray, along: np.ndarray) -> Iterator[np.ndarray]:
    """Possible orders of measurement: each series alone, series in succession, and interleaved."""
    parts = [rows[series[rows] == number] for number in np.unique(series[rows])]
    yield from parts
    if len(parts) > 1:
        yield rows
        yield rows[np.argsort(along[rows], kind="stable")]


class Unexplained:
    """The residuals that an arm leaves unexplained, and tests of further parameters on them.

    Args:
        residuals: (n, k) over their noise.
        arm: (n, k, P) slopes of the residuals by parameters over their deviations.
        redundancy: the rows per posture. They have the same unexplained residuals, so they count as
            one row in significance tests.
    """

    def __init__(self, residuals: np.ndarray, arm: np.ndarray, redundancy: float):
        self._residuals, self._arm, self._redundancy = residuals, arm, redundancy
        self._gradient = np.einsum("nkp,nk->p", arm, residuals)
        rows = arm.reshape(-1, arm.shape[-1])
        information = rows.T @ rows
        self._factor = scipy.linalg.cho_factor(information + np.eye(len(information)))
        self._squares = np.sum(residuals**2) - self._gradient @ self._solve(self._gradient)
        self._free = np.count_nonzero(residuals) - np.trace(self._solve(information))

    def strongest(self, candidate: Candidate) -> tuple[float, np.ndarray, np.ndarray]:
        """A fault's share of the unexplained squares; 0 if it is not significant.

        Also returns its window (2,) among the candidate's rows, and its parameters (c,).
        """
        _, numbers, columns, windows = candidate
        windows = np.array([[0, len(columns)]]) if windows is None else windows
        products = (
            np.einsum("nkc,nkd->ncd", columns, columns),
            np.einsum("nkc,nkp->ncp", columns, self._arm[numbers]),
            np.einsum("nkc,nk->nc", columns, self._residuals[numbers]),
        )
        if not len(windows) or self._free <= columns.shape[-1]:
            return 0.0, np.zeros(2, dtype=int), np.zeros(columns.shape[-1])
        firsts, lasts = windows.T
        sums = (np.concatenate([0 * part[:1], np.cumsum(part, axis=0)]) for part in products)
        information, across, gradient = (part[lasts] - part[firsts] for part in sums)
        absorbed = self._solve(across.reshape(-1, across.shape[-1]).T).T.reshape(across.shape)
        information = information - absorbed @ across.swapaxes(1, 2)
        gradient = gradient - absorbed @ self._gradient
        found = (np.linalg.pinv(information, hermitian=True) @ gradient[..., None])[..., 0]
        gains = np.sum(found * gradient, axis=1)
        squares = np.cumsum([0.0, *np.sum(self._residuals[numbers] ** 2, axis=1)])
        # else these would be separate outliers, one after the other
        alike = (lasts == len(columns)) | (gains > ALIKE * (squares[lasts] - squares[firsts]))
        gains = np.where(alike, gains, 0.0)
        best, count = int(gains.argmax()), columns.shape[-1]
        gain, free = gains[best], (self._free - count) / self._redundancy
        ratio = gain / count / (self._squares - gain) * free
        significant = fdtrc(count, free, ratio) * len(windows) < CHANCE
        return gain / self._squares if significant else 0.0, windows[best], found[best]

    def _solve(self, gradients: np.ndarray) -> np.ndarray:
        return scipy.linalg.cho_solve(self._factor, gradients)


def _times(observations: Observations) -> np.ndarray:
    """The times (n,) of the rows, in seconds, or their numbers if no times were recorded."""
    return np.arange(len(observations)) if observations.times is None else observations.times


def _late(geometry: Calibration, observations: Observations, times: np.ndarray) -> np.ndarray:
    """Backward velocities (n, k) of targets [m, rad per s or row] during the step to each row."""
    small = SMALL * np.median(np.diff(np.unique(times)))
    here = geometry.predict(observations.joints, observations.targets)
    earlier = observations.joints - small * _speeds(observations.joints, times)
    before = geometry.predict(earlier, observations.targets)
    return displacements(here, before)[:, : 3 * observations.kinds] / small


def _speeds(joints: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Velocities (n, joints) of the step to each row; rows of the same time share one."""
    times, first, numbers = np.unique(times, return_index=True, return_inverse=True)
    speeds = np.diff(joints[first], axis=0) / np.diff(times)[:, None]
    return np.concatenate([0 * speeds[:1], speeds])[numbers]


def _moved(poses: np.ndarray, instruments: np.ndarray) -> np.ndarray:
    """Displacements (n, 6, 6) of poses by motions of 1 m and 1 rad of their instruments (n,)."""
    columns = np.tile(np.eye(6), (len(poses), 1, 1))
    for number in np.unique(instruments):
        rows = instruments == number
        places = poses[rows, :3, 3]
        columns[rows, :3, 3:] = -crosses(places - places.mean(axis=0))
    return columns
