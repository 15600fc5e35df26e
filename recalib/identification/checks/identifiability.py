"""Parameters of the geometry that are not identifiable from the measurements.

Parameters are added one by one to the identifiable ones: frames, then joint offsets, then links,
and last those whose effect the others can almost fully reproduce. A parameter is not identifiable
if the data's information on it, with all parameters before it free, is less than its prior's. The
parameters that can compensate for it are its partners.
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
POSTURES = 200  # over the joints' ranges: they represent all possible measurements of this kind
SEATED, STEPS = 1e-9, 50  # m: the tolerance of a ball in its socket; Newton's steps to reach it
# The fraction of a parameter's information that the other parameters cannot reproduce, if links are
# bent by two degrees, and if they are not bent at all.
WEAK, ROUNDING = 1e-3, 1e-8
PARTNERS, SHARE = 3, 0.3  # the most partners, and their least effect over the largest effect
DIGITS = 6  # of an effect over the largest: rounding must not order targets that tie


@dataclass(frozen=True)
class Unidentifiable:
    """A parameter that is not identifiable.

    Attributes:
        parameter: the number of the parameter.
        partners: the numbers of the parameters that can compensate for it, the strongest first;
            empty if the data have no information on it at all.
        lasting: whether no measurements of this kind would make it identifiable.
    """

    parameter: int
    partners: tuple[int, ...]
    lasting: bool


def unidentifiable_parameters(
    calibration: Calibration, observations: Observations
) -> list[Unidentifiable]:
    """The parameters of the geometry that are not identifiable, in the order above."""
    model, estimate = calibration.model, calibration.estimate
    order = _order(model)
    root = Unseen(model, observations).left_out(_root(calibration, observations, estimate.weights))
    others = anywhere(model, observations, POSTURES)
    if observations.sockets is not None:
        pairs = np.unique(np.stack([observations.targets, observations.sockets]), axis=1)
        others = _seated(calibration, others.joints, pairs)
    further = _root(calibration, others, np.ones(len(others)))
    # A shift along an axis is the same before and behind the axis. Only because a link is bent, the
    # first of two such parameters seems identifiable, at the second's expense: so it goes last.
    ordered = root[:, order]
    weak = _dependent(ordered, WEAK * np.sum(ordered**2, axis=0))
    order = _last(order, [number for number, _ in weak])
    found = dict(_dependent(root[:, order], np.full(len(order), IDENTIFIABLE)))
    # For other measurements these come last, so that all that could compensate for them is free.
    again = _last(np.arange(len(order)), [*found])
    further = further[:, order[again]]
    least = ROUNDING * np.maximum(np.sum(further**2, axis=0), IDENTIFIABLE)
    lasting = {int(again[number]) for number, _ in _dependent(further, least)}
    return [
        Unidentifiable(int(order[number]), tuple(order[partners].tolist()), number in lasting)
        for number, partners in found.items()
    ]


def _last(order: np.ndarray, some: list[int]) -> np.ndarray:
    """The same order (p,), but with the elements at some places moved to the end."""
    return np.concatenate([np.delete(order, some), order[some]])


def _order(model: ErrorModel) -> np.ndarray:
    """The numbers of the geometry's parameters that are not held: frames, offsets, links."""
    numbers = geometry_of(model)
    offsets = numbers >= model.offset_columns.start
    return numbers[np.lexsort([~offsets, ~model.free[numbers]])]


def _root(calibration: Calibration, observations: Observations, weights: np.ndarray) -> np.ndarray:
    """R (P, P) with R' R the data's information on parameters over their prior deviations.

    R comes from the slopes and not from their squares, in which rounding destroys small numbers.
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
    """Balls in sockets, by pairs (2, p), in postures near joints (n, joints) that reach them."""
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
    """Each column with less information than `least` (p,) beyond its predecessors; its partners."""
    accepted: list[int] = []
    for number, column in enumerate(root.T):
        combination = np.linalg.lstsq(root[:, accepted], column, rcond=None)[0]
        residual = column - root[:, accepted] @ combination
        if residual @ residual >= least[number]:
            accepted.append(number)
            continue
        effects = np.abs(combination) * np.linalg.norm(root[:, accepted], axis=0)
        largest = effects.max(initial=0.0)
        weakest = SHARE * largest if largest**2 >= least[number] else np.inf
        rounded = np.round(effects / (largest or 1.0), DIGITS)
        strongest = np.argsort(-rounded, kind="stable")[:PARTNERS]
        yield number, [accepted[n] for n in strongest if effects[n] >= weakest]
