"""Faults in the sequence of rows: poses that lag behind the joints, a drift, a jump, a slip.

Rows in the order of measurement show such faults in their residuals. Each fault is modelled by
parameters in addition to those of the arm: the delay of all poses as a part of a step; the growth
of an arm that warms up; a motion of the instrument relative to the base, over time or from some row
on; or one of a target on the tool. Of several cameras, each may have faults of its own. A fault
that no arm could explain instead, and that is too large for chance, is reported. All rows take
part, also those that are far off: after a jump all are. But no single one decides.
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
from recalib.identification.model.linearisation import Linearisation, displacements
from recalib.identification.model.observations import Observations

LAG, DRIFT, GROWTH, JUMP, SLIP = "lag", "drift", "growth", "jump", "slip"
CHANCE = 1e-6  # of a reported fault, were all residuals noise
SHARE = 0.15  # of the squares of residuals; a real arm's residuals are more than noise
MOST = 3  # faults at once
ENDS = 5  # rows on either side of a jump
# Times the noise: of a row that is farther off, the distance counts and not its square; if that
# shows no fault, as among gross outliers, it hardly counts at all
FAR = 4.0
SMALL = 1e-3  # of the typical step: for slopes


@dataclass(frozen=True)
class Fault:
    """Something that rows show by their order.

    Attributes:
        kind: lag, drift, growth (of the arm), jump (of the instrument) or slip (of a target).
        size: of a lag, by how many seconds poses are late, or, of rows without times, by what part
            of the step to each; of growth, by what part from the first row to the last; otherwise
            m, by how much the instrument moves against the base, from the first row to the last or
            at once, or the target against the tool.
        row: from 0 in its series, the first one after a jump or a slip.
        turn: rad, that goes with the size.
        sight: the number of this row's sight.
    """

    kind: str
    size: float
    row: int = 0
    turn: float = 0.0
    sight: int = 0


def faults(geometry: Calibration, observations: Observations) -> list[Fault]:
    """What rows show by their order in each series; the geometry was identified by the same rows.

    A lag bends the arm that is identified, and so leaves more than a lag. If it is the plainest
    fault, all others are looked for without it.
    """
    found = _faults(geometry, observations, 1) or _faults(geometry, observations, 2)
    if len(found) < 2 or found[0].kind != LAG:
        return found
    # at the joint coordinates of the moments at which poses were measured
    lag, joints, series = found[0], observations.joints.copy(), observations.series
    rows = series == series[observations.targets == lag.sight][0]
    joints[rows] -= lag.size * _speeds(joints[rows], _times(observations)[rows])
    punctual = replace(observations, joints=joints)
    again = identify(geometry.model, punctual, geometry.estimate, geometry.estimate.weights)
    others = _faults(replace(geometry, estimate=again), punctual, 1)
    others = [fault for fault in others if (fault.kind, fault.sight) != (LAG, lag.sight)]
    return [lag, *others][:MOST]


def _faults(geometry: Calibration, observations: Observations, power: int) -> list[Fault]:
    """The same, all by one linearisation, with weights that fall by a power of the distance."""
    residuals, arm, weights, model = slopes_of(geometry, observations, power)
    estimate = geometry.estimate
    postures = find_postures(observations.joints, model.nominal.slides, estimate.noise[0])
    alike = len(observations) / len(postures)
    candidates = [
        one._replace(columns=one.columns * weights[one.rows, :, None])
        for one in _candidates(geometry, observations)
    ]
    found: list[Fault] = []
    while len(found) < MOST:  # the plainest first, then what it does not explain
        rest = Unexplained(residuals, arm, alike)
        tried = [(*rest.plainest(candidate), candidate) for candidate in candidates]
        share, after, by, (kind, rows, columns, _) = max(tried, key=lambda one: one[0])
        if share < SHARE:
            break
        size = by[0] if len(by) == 1 else np.linalg.norm(by[:3])
        turn = np.linalg.norm(by[3:])
        series = observations.series == observations.series[rows[after]]
        row, sight = int(series[: rows[after]].sum()), int(observations.targets[rows[after]])
        found.append(Fault(kind, float(size), row, float(turn), sight))
        further = np.zeros((*residuals.shape, columns.shape[-1]))
        further[rows[after:]] = columns[after:]
        arm = np.concatenate([arm, further], axis=2)
    return found


class Slopes(NamedTuple):
    """Residuals and their slopes, weighted.

    Attributes:
        residuals: (n, k) over their noise.
        arm: (n, k, P) their slopes by the model's parameters over their deviations.
        weights: (n, k) of both.
        model: geometry with joint errors.
    """

    residuals: np.ndarray
    arm: np.ndarray
    weights: np.ndarray
    model: ErrorModel


def slopes_of(geometry: Calibration, observations: Observations, power: int) -> Slopes:
    """Those of all rows, which count less the farther off they are, by a power of the distance."""
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
    """A fault that there may be.

    Attributes:
        kind: of the fault.
        rows: (m,) numbers of the rows that it concerns, in the order of their measurement.
        columns: (m, k, c) slopes of their residuals by the fault's parameters.
        ends: the fewest rows on either side of where the fault begins; 0: with the first row.
    """

    kind: str
    rows: np.ndarray
    columns: np.ndarray
    ends: int = 0


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
        if clock[0] == clock[-1]:  # a camera that took one picture: nothing is late or drifts
            continue
        passed[rows] = (clock - clock[0]) / np.ptp(clock)
        yield Candidate(LAG, rows, part.whitened(_late(geometry, part, clock))[..., None])
        yield Candidate(DRIFT, rows, moved[rows] * passed[rows, None, None])
        yield Candidate(GROWTH, rows, grown[rows] * passed[rows, None, None])
    along = passed if observations.times is None else times
    for kind, numbers, columns in ((JUMP, instruments, moved), (SLIP, targets, slipped)):
        for number in np.unique(numbers):
            for rows in _orders(np.flatnonzero(numbers == number), observations.series, along):
                yield Candidate(kind, rows, columns[rows], ENDS)


def _orders(rows: np.ndarray, series: np.ndarray, along: np.ndarray) -> Iterator[np.ndarray]:
    """Rows as they may have been measured: each series, one after the other, or side by side."""
    parts = [rows[series[rows] == number] for number in np.unique(series[rows])]
    yield from parts
    if len(parts) > 1:
        yield rows
        yield rows[np.argsort(along[rows], kind="stable")]


class Unexplained:
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

    def plainest(self, candidate: Candidate) -> tuple[float, int, np.ndarray]:
        """A fault's share of the unexplained squares, 0 where that may be chance.

        Returns also with which of its rows it begins, and its parameters (c,).
        """
        _, numbers, columns, ends = candidate
        products = (
            np.einsum("nkc,nkd->ncd", columns, columns),
            np.einsum("nkc,nkp->ncp", columns, self._arm[numbers]),
            np.einsum("nkc,nk->nc", columns, self._residuals[numbers]),
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


def _times(observations: Observations) -> np.ndarray:
    """When rows were measured (n,), in seconds, or in rows if no time was recorded."""
    return np.arange(len(observations)) if observations.times is None else observations.times


def _late(geometry: Calibration, observations: Observations, times: np.ndarray) -> np.ndarray:
    """How targets go back with time (n, k) [m, rad], at the speed of the step to each row."""
    small = SMALL * np.median(np.diff(np.unique(times)))
    here = geometry.predict(observations.joints, observations.targets)
    earlier = observations.joints - small * _speeds(observations.joints, times)
    before = geometry.predict(earlier, observations.targets)
    return displacements(here, before)[:, : 3 * observations.kinds] / small


def _speeds(joints: np.ndarray, times: np.ndarray) -> np.ndarray:
    """How fast joints (n, joints) moved on the step to each row; rows at one time are as fast."""
    times, first, numbers = np.unique(times, return_index=True, return_inverse=True)
    speeds = np.diff(joints[first], axis=0) / np.diff(times)[:, None]
    return np.concatenate([0 * speeds[:1], speeds])[numbers]


def _moved(poses: np.ndarray, instruments: np.ndarray) -> np.ndarray:
    """What moves of their instruments (n,) by 1 m and 1 rad do to poses (n, 6, 6)."""
    columns = np.tile(np.eye(6), (len(poses), 1, 1))
    for number in np.unique(instruments):
        rows = instruments == number
        places = poses[rows, :3, 3]
        levers = (places - places.mean(axis=0))[:, None]
        columns[rows, :3, 3:] = np.cross(np.eye(3), levers).swapaxes(1, 2)
    return columns
