"""Hand-eye calibration: where a camera and a board are, by the poses of an arm's flange.

See `hand_eye_model` for the equations. Closed forms start a search by Gauss' and Newton's steps.
The accuracy of the arm and the weights of poses that do not fit are found with it, in turn.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from recalib.identification.closed_forms import solutions
from recalib.identification.hand_eye_model import ENDS, HandEye, LinearHandEye, Sights
from recalib.identification.model.frames import nearest_rotation
from recalib.identification.model.observations import Observations

STEPS, ROUNDS, SMALL = 40, 20, 1e-8  # of a fit; of the noise and the weights; m, rad
FAR = 16.8  # squares of deviations: of 6 numbers, 1 % are farther off; they count the less
SETTLED = 0.01  # a change of weights
FINEST, COARSEST = 1e-7, 1.0  # m, rad: no arm is as accurate, or as bad
FOLDS = 30
TURNS = 24  # about the only axis, to start from
ONE_AXIS = 1.5  # deg: turns about a second axis that are smaller tell nothing


def calibrate_hand_eye(sights: Sights) -> HandEye:
    """The most likely calibration; what the poses leave open stays where a start has it."""
    found = _weighed(closest_start(sights))
    for _ in range(ROUNDS):
        before = found.weights
        found = _weighed(_moved_to_best(_with_noise(found)))
        if np.abs(found.weights - before).max() < SETTLED:
            break
    return found


def _weighed(found: HandEye) -> HandEye:
    """The same, with weights by how far off poses are, in deviations."""
    linear = LinearHandEye(found)
    distances = linear.distances(linear.residuals)
    return replace(found, weights=np.minimum(FAR / np.maximum(distances, FAR), 1.0))


def closest_start(sights: Sights) -> HandEye:
    """The best of all starts, with no weight less than others."""
    return min(map(_first, starts(sights)), key=lambda one: one.misfit)


def starts(sights: Sights) -> Iterator[HandEye]:
    """Closed forms; if the flange turned about one axis alone, several."""
    between, board = sights.between, sights.board
    count = ENDS + sights.corners.slopes.shape[-1]
    blank = np.zeros(count - ENDS), np.zeros(2), np.zeros(2), np.zeros((count, count))
    if sights.axes[0][1] < ONE_AXIS:
        ends = _about_one_axis(between, board)
    else:
        frames = solutions(between, Observations(np.zeros((len(sights), 0)), board))
        ends = ((np.linalg.inv(one.base), one.targets[0]) for one in frames)
    for pair in ends:
        yield HandEye(sights, *pair, *blank, np.ones(len(sights)))


def _about_one_axis(
    between: np.ndarray, board: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The axis in the camera is that of the arm; the turn about it is tried all around."""
    pairs = [poses[:, :3, :3] @ poses[0, :3, :3].T for poses in (between, board)]
    arm, camera = (Rotation.from_matrix(turns).as_rotvec() for turns in pairs)
    across, axis = nearest_rotation(arm.T @ camera), np.linalg.svd(arm)[2][0]
    for angle in 2 * np.pi * np.arange(TURNS) / TURNS:
        turn = Rotation.from_rotvec(angle * axis).as_matrix() @ across
        turns = between[:, :3, :3].swapaxes(1, 2) @ turn @ board[:, :3, :3]
        ends = np.tile(np.eye(4), (2, 1, 1))
        ends[:, :3, :3] = turn, Rotation.from_matrix(turns).mean().as_matrix()
        # R_X y + x = R_G z + t_G
        unit = np.tile(-np.eye(3), (len(board), 1, 1))
        system = np.concatenate([between[:, :3, :3], unit], axis=2).reshape(-1, 6)
        goal = board[:, :3, 3] @ turn.T - between[:, :3, 3]
        ends[1, :3, 3], ends[0, :3, 3] = np.linalg.lstsq(system, goal.ravel())[0].reshape(2, 3)
        yield ends[0], ends[1]


def _first(start: HandEye) -> HandEye:
    """The best from a start, with the accuracy that most poses show there."""
    sizes = np.abs(start.residuals(start.sights)).reshape(-1, 2, 3)
    accuracy = np.maximum(np.median(sizes, axis=(0, 2)), FINEST)
    return _moved_to_best(replace(start, accuracy=accuracy))


def information(found: HandEye, sights: Sights) -> np.ndarray:
    """What each of further poses would say of camera and board: (n, 12, 12)."""
    linear = LinearHandEye(replace(found, sights=sights, weights=np.ones(len(sights))))
    slopes = linear.slopes[..., :ENDS]
    return slopes.swapaxes(1, 2) @ linear.precisions @ slopes


def held_out(found: HandEye) -> np.ndarray:
    """Residuals (n, 6) [m, rad] of each pose by a calibration without it and its fold."""
    count = len(found.sights)
    folds, residuals = np.arange(count) % min(count, FOLDS), np.zeros((count, 6))
    for fold in range(min(count, FOLDS)):
        rows, out = np.flatnonzero(folds != fold), np.flatnonzero(folds == fold)
        without = replace(found, sights=found.sights[rows], weights=found.weights[rows])
        residuals[out] = _moved_to_best(without).residuals(found.sights[out])
    return residuals


def _with_noise(found: HandEye) -> HandEye:
    """The same with the most likely accuracy of the arm, and noise of poses in a table."""
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
    """The best camera, board and optics by the noise and weights of a calibration."""
    for _ in range(STEPS):
        linear = LinearHandEye(found)
        information, gradient = linear.normal_equations(linear.precisions, found.weights)
        scale = 1 / np.sqrt(np.maximum(information.diagonal(), np.finfo(float).tiny))
        inverse = np.linalg.pinv(information * scale * scale[:, None], rcond=1e-12, hermitian=True)
        covariance = inverse * scale * scale[:, None]
        step = covariance @ gradient
        found = replace(
            found,
            camera=_moved(found.camera, step[:6]),
            board=_moved(found.board, step[6:ENDS]),
            optics=found.optics + step[ENDS:],
            covariance=covariance,
        )
        if np.abs(step[:ENDS]).max() < SMALL:
            break
    return found


def _moved(pose: np.ndarray, step: np.ndarray) -> np.ndarray:
    """A pose displaced by (6,) m and rad along and about the axes of its frame."""
    moved = pose.copy()
    moved[:3, 3] += step[:3]
    moved[:3, :3] = Rotation.from_rotvec(step[3:]).as_matrix() @ pose[:3, :3]
    return moved
