"""Hand-eye calibration: the poses of a camera and a board, from the poses of an inexact arm.

Closed forms start a Gauss-Newton search. It alternates with estimates of the arm's pose accuracy,
which maximises the restricted likelihood (Patterson and Thompson 1971), and of the weights of poses
that do not fit. The deviations allow for errors of the arm that vary smoothly with its pose.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from recalib.identification.closed_forms import solutions
from recalib.identification.model.frames import nearest_rotation
from recalib.identification.model.hand_eye_model import ENDS, HandEye, LinearHandEye, Sights
from recalib.identification.model.linearisation import displaced
from recalib.identification.model.observations import Observations
from recalib.identification.smooth_errors import with_smooth_errors

# Steps of a fit; rounds of noise and weights; the step [m, rad] at which a fit has converged.
STEPS, ROUNDS, SMALL = 40, 20, 1e-8
LONGEST = 0.5  # rad: the longest step
FAR = 16.8  # the 99 % quantile of chi-square with 6 degrees of freedom; beyond it, weights fall
SETTLED = 0.01  # the largest change of weights at convergence
FINEST, COARSEST = 1e-7, 1.0  # m, rad: bounds on the accuracy of any arm
FOLDS = 30
EQUAL = 0.05  # rad: angles that may be the same
TURNS = 24  # starting angles about the only axis
OPEN = 1e-3  # of the largest singular value: smaller ones leave a direction undetermined
ONE_AXIS = 1.5  # deg: smaller turns about a second axis determine nothing


def calibrate_hand_eye(sights: Sights) -> HandEye:
    """The most likely calibration; directions that poses do not determine stay as at the start."""
    found = _weighed(min(map(_first, starts(sights)), key=lambda one: one.misfit))
    for _ in range(ROUNDS):
        before = found.weights
        found = _weighed(_moved_to_best(_with_noise(found)))
        if np.abs(found.weights - before).max() < SETTLED:
            break
    return with_smooth_errors(found)


def upended(flange: np.ndarray, board: np.ndarray) -> np.ndarray:
    """Whether each picture (n,) shows a symmetric board upside down relative to most others.

    Between two pictures, the flange and the board turn by equal angles. So each pair of pictures
    favours equal or opposite orientations of the board. None counts as upside down if orientations
    do not explain the angles: then the poses (n, 4, 4) of flange or board are wrong.
    """
    arm, shown = flange[:, :3, :3], board[:, :3, :3]
    ones, others = np.stack([arm, shown, shown * [-1, -1, 1]]), np.stack([arm, shown, shown])
    traces = np.einsum("snij,smij->snm", ones, others)
    angles, same, turned = np.arccos(np.clip((traces - 1) / 2, -1, 1))
    same, turned = np.abs(same - angles), np.abs(turned - angles)
    side = np.linalg.eigh(turned - same)[1][:, -1] > 0
    other: np.ndarray = side != (np.mean(side) > 0.5)
    remaining = np.where(other[:, None] == other, same, turned)
    return other & (np.median(remaining) < EQUAL)


def _weighed(found: HandEye) -> HandEye:
    """The same, with weights from the poses' residuals over their deviations; the largest is 1."""
    linear = LinearHandEye(found)
    rows = linear.residuals
    squares = np.einsum("ni,nij,nj->n", rows, linear.precisions, rows)
    far = max(FAR, squares.min())  # if the assumed noise is too small, all might lose their weight
    return replace(found, weights=far / np.maximum(squares, far))


def starts(sights: Sights) -> Iterator[HandEye]:
    """Closed-form solutions; several if the flange turned about one axis alone."""
    if sights.axes[0][1] < ONE_AXIS:
        ends = _about_one_axis(sights.between, sights.board)
    else:
        observations = Observations(np.zeros((len(sights), 0)), sights.board)
        frames = solutions(sights.between, observations)
        ends = ((np.linalg.inv(one.base), one.targets[0]) for one in frames)
    return (HandEye.at(sights, camera, board) for camera, board in ends)


def _about_one_axis(
    between: np.ndarray, board: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Poses of camera and board for turns all around the one axis of both arm and camera."""
    pairs = [poses[:, :3, :3] @ poses[0, :3, :3].T for poses in (between, board)]
    arm, camera = (Rotation.from_matrix(turns).as_rotvec() for turns in pairs)
    across, axis = nearest_rotation(arm.T @ camera), np.linalg.svd(arm, full_matrices=False)[2][0]
    for angle in 2 * np.pi * np.arange(TURNS) / TURNS:
        turn = Rotation.from_rotvec(angle * axis).as_matrix() @ across
        turns = between[:, :3, :3].swapaxes(1, 2) @ turn @ board[:, :3, :3]
        ends = np.tile(np.eye(4), (2, 1, 1))
        ends[:, :3, :3] = turn, Rotation.from_matrix(turns).mean().as_matrix()
        # R_X y + x = R_G z + t_G
        unit = np.tile(-np.eye(3), (len(board), 1, 1))
        system = np.concatenate([between[:, :3, :3], unit], axis=2).reshape(-1, 6)
        goal = board[:, :3, 3] @ turn.T - between[:, :3, 3]
        best = np.linalg.lstsq(system, goal.ravel(), rcond=OPEN)[0]
        ends[1, :3, 3], ends[0, :3, 3] = best.reshape(2, 3)
        yield ends[0], ends[1]


def _first(start: HandEye) -> HandEye:
    """The best calibration near a start, with the accuracy of the arm from medians there."""
    sizes = np.abs(start.residuals(start.sights)).reshape(-1, 2, 3)
    accuracy = np.maximum(np.median(sizes, axis=(0, 2)), FINEST)
    return _moved_to_best(replace(start, accuracy=accuracy))


def information(found: HandEye) -> np.ndarray:
    """The information (n, 12, 12) that each pose has on the poses of camera and board."""
    linear = LinearHandEye(found)
    slopes = linear.slopes[..., :ENDS]
    return slopes.swapaxes(1, 2) @ linear.precisions @ slopes


def held_out(found: HandEye, folds: np.ndarray | None = None) -> np.ndarray:
    """Residuals (n, 6) [m, rad] of each pose from a calibration without its fold.

    `folds` (n,) numbers the fold of each pose; by default, poses go to 30 folds in turn.
    """
    residuals = np.zeros((len(found.sights), 6))
    folds = np.arange(len(residuals)) % FOLDS if folds is None else folds
    for fold in np.unique(folds):
        rows, out = np.flatnonzero(folds != fold), np.flatnonzero(folds == fold)
        without = replace(found, sights=found.sights[rows], weights=found.weights[rows])
        residuals[out] = _moved_to_best(without).residuals(found.sights[out])
    return residuals


def _with_noise(found: HandEye) -> HandEye:
    """The same, with the most likely accuracy of the arm and, for poses from a table, noise."""
    linear, by_table = LinearHandEye(found), found.sights.optics is None
    start = [*found.accuracy, *np.maximum(found.noise, found.accuracy / 10)[: 2 * by_table]]

    def split(logarithms: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sizes = np.exp(np.clip(logarithms, *np.log([FINEST, COARSEST])))
        return sizes[:2], np.resize([*sizes[2:], 0, 0], 2)

    best = minimize(
        lambda logarithms: linear.unlikelihood(*split(logarithms)),
        np.log(np.maximum(start, FINEST)),
        method="Nelder-Mead",
        options={"xatol": 1e-2, "fatol": 1e-3, "maxiter": 400},
    )
    accuracy, noise = split(best.x)
    return replace(found, accuracy=accuracy, noise=noise)


def _moved_to_best(found: HandEye) -> HandEye:
    """The best camera, board and optics, given the noise and weights of a calibration."""
    sights = found.sights
    reach = max(np.abs(poses[:, :3, 3]).max() for poses in (sights.flange, sights.board))
    for _ in range(STEPS):
        linear = LinearHandEye(found)
        information, gradient = linear.normal_equations(linear.precisions, found.weights)
        scale = 1 / np.sqrt(np.maximum(information.diagonal(), np.finfo(float).tiny))
        inverse = np.linalg.pinv(information * scale * scale[:, None], rcond=1e-12, hermitian=True)
        covariance = inverse * scale * scale[:, None]
        step = covariance @ gradient
        positions, turns = np.abs(step[:ENDS].reshape(2, 2, 3)).max(axis=(0, 2))
        step /= max(1.0, positions / reach, turns / LONGEST)  # longer steps may never converge
        camera, board = displaced(found.camera, step[:6]), displaced(found.board, step[6:ENDS])
        optics = found.optics + step[ENDS:]
        found = replace(found, camera=camera, board=board, optics=optics, covariance=covariance)
        if np.abs(step[:ENDS]).max() < SMALL:
            break
    return found
