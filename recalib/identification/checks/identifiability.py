"""Parameters of the geometry that are not identifiable from the measurements.

Parameters are added one by one to the identifiable ones: frames, then joint offsets, then links,
and last those of which others leave next to nothing. One is not identifiable if the data's
information on it, with all before it free, is less than its prior's. The parameters that can
compensate for it are its partners.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from recalib.identification.calibration import Calibration
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import Linearisation
from recalib.identification.model.observations import Observations
from recalib.identification.unseen import Unseen, anywhere, geometry_of
from recalib.nominal.newton import solve_groups

IDENTIFIABLE = 1.0  # the least information on an identifiable parameter, over its prior's
POSTURES = 200  # all over the joints' ranges: they stand for all measurements of this kind
SEATED, STEPS = 1e-9, 50  # m: how well a ball sits in its socket, and Newton's steps to there
# Of a parameter's own information: the part that others leave if links are bent by two degrees, and
# if they are not bent at all.
WEAK, ROUNDING = 1e-3, 1e-8
PARTNERS, SHARE = 3, 0.3  # so many at most, whose effect is that part of the largest at least
DIGITS = 6  # of an effect over the largest: where several targets tie, rounding does not decide


@dataclass(frozen=True)
class Unidentifiable:
    """A parameter that is not identifiable.

    Attributes:
        parameter: its number.
        partners: the numbers of the parameters that can compensate for it, the strongest first;
            none if the data have no information on it at all.
        lasting: whether no measurements of this kind would make it identifiable.
    """

    parameter: int
    partners: tuple[int, ...]
    lasting: bool


def unidentifiable_parameters(
    calibration: Calibration, observations: Observations
) -> list[Unidentifiable]:
    """The parameters of geometry that are not identifiable, in the order above."""
    model, estimate = calibration.model, calibration.estimate
    order = _order(model)
    root = Unseen(model, observations).left_out(_root(calibration, observations, estimate.weights))
    others = anywhere(model, observations, POSTURES)
    if observations.sockets is not None:
        pairs = np.unique(np.stack([observations.targets, observations.sockets]), axis=1)
        others = _seated(calibration, others.joints, pairs)
    more = _root(calibration, others, np.ones(len(others)))
    # What goes along an axis is the same before and behind it. By a bent link alone the first of
    # two such parameters seems identifiable, and then the second does not: the first comes last.
    ordered = root[:, order]
    weak = _dependent(ordered, WEAK * np.sum(ordered**2, axis=0))
    order = _last(order, [number for number, _ in weak])
    found = dict(_dependent(root[:, order], np.full(len(order), IDENTIFIABLE)))
    # For other measurements these come last: all that could compensate for them is free.
    again = _last(np.arange(len(order)), [*found])
    more = more[:, order[again]]
    least = ROUNDING * np.maximum(np.sum(more**2, axis=0), IDENTIFIABLE)
    lasting = {int(again[number]) for number, _ in _dependent(more, least)}
    return [
        Unidentifiable(int(order[number]), tuple(order[partners].tolist()), number in lasting)
        for number, partners in found.items()
    ]


def _last(order: np.ndarray, some: list[int]) -> np.ndarray:
    """The same order (p,), but what stands at some places comes last."""
    return np.concatenate([np.delete(order, some), order[some]])


def _order(model: ErrorModel) -> np.ndarray:
    """Numbers of the parameters of geometry that are not held: frames, offsets, links."""
    numbers = geometry_of(model)
    offsets = numbers >= model.offset_columns.start
    return numbers[np.lexsort([~offsets, ~model.free[numbers]])]


def _root(calibration: Calibration, observations: Observations, weights: np.ndarray) -> np.ndarray:
    """R (P, P) with R' R the data's information on parameters over their prior deviations.

    R is of the slopes themselves: in their squares, small numbers are lost to rounding.
    """
    model, estimate = calibration.model, calibration.estimate
    parameters = estimate.parameters / model.deviations
    linear = Linearisation(model, parameters, observations)
    root = np.empty((0, len(parameters)))
    for jacobians, noise in zip(linear.jacobians, estimate.noise, strict=True):
        rows = jacobians * (np.sqrt(weights) / noise)[:, None, None]
        root = np.linalg.qr(np.concatenate([root, rows.reshape(-1, len(parameters))])).R
    return root


def _seated(calibration: Calibration, joints: np.ndarray, pairs: np.ndarray) -> Observations:
    """Balls in sockets, pairs (2, p), in postures near the given ones (n, joints) that reach."""
    targets, sockets = pairs[:, np.arange(len(joints)) % pairs.shape[1]]
    goals = calibration.frames.sockets[sockets]
    parametric = replace(calibration, pattern=None)

    def kinematics(rows: np.ndarray, postures: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        poses, jacobians = parametric.predict_and_jacobian(postures[:, 0], targets[rows])
        return poses[:, None], jacobians[:, None]

    found, errors = solve_groups(kinematics, goals[:, None], joints[:, None], SEATED, STEPS)
    reached = errors[:, 0] <= SEATED
    return Observations(found[reached, 0], None, targets[reached], sockets[reached])


def _dependent(root: np.ndarray, least: np.ndarray) -> Iterator[tuple[int, list[int]]]:
    """Each column that those before it leave less information of than `least` (p,); partners."""
    accepted: list[int] = []
    for number, column in enumerate(root.T):
        makes_up = np.linalg.lstsq(root[:, accepted], column, rcond=None)[0]
        left = column - root[:, accepted] @ makes_up
        if left @ left >= least[number]:
            accepted.append(number)
            continue
        effects = np.abs(makes_up) * np.linalg.norm(root[:, accepted], axis=0)
        largest = effects.max(initial=0.0)
        weakest = SHARE * largest if largest**2 >= least[number] else np.inf
        alike = np.round(effects / (largest or 1.0), DIGITS)
        strongest = np.argsort(-alike, kind="stable")[:PARTNERS]
        yield number, [accepted[one] for one in strongest if effects[one] >= weakest]
