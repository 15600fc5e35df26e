"""A camera, a board or a flange's frame that moved amid the rows of a hand-eye calibration.

A motion is looked for as in `sequence`, but without a model of the arm, whose errors drift along a
path and resemble one. So the motion is undone, and a fit without it shows the noise. It must then
be plain again, next to errors of the flange that are linear in its pose and as large as this noise,
with rows that count the less, the more the residuals of successive rows are correlated.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.checks.sequence import (
    ENDS,
    JUMP,
    MOST,
    SHARE,
    SLIP,
    Candidate,
    Fault,
    Unexplained,
)
from recalib.identification.hand_eye import FINEST, calibrate_hand_eye
from recalib.identification.model.hand_eye_model import (
    CAMERA,
    TARGET,
    HandEye,
    LinearHandEye,
    Sights,
)
from recalib.identification.model.linearisation import displaced

Motion = tuple[float, int, np.ndarray, slice]  # its share, first row, size (6,), and of which end


def moved_ends(found: HandEye) -> tuple[list[Fault], HandEye]:
    """Jumps of what is next to the arm, slips of what is on the flange, and a fit without them."""
    faults: list[Fault] = []
    for _ in range(MOST):
        motion = _plainest(found)
        if motion[0] < SHARE:
            break
        still = calibrate_hand_eye(_undone(found, motion))
        residuals, _, _ = _whitened(still)
        alike = max(0.0, np.sum(residuals[1:] * residuals[:-1]) / np.sum(residuals**2))
        refitted = replace(still, sights=found.sights)
        share, row, by, end = motion = _plainest(refitted, alike)
        if share < SHARE:
            break
        kind = SLIP if found.sights.in_hand == (end == CAMERA) else JUMP
        size, turn = np.linalg.norm(by.reshape(2, 3), axis=1)
        if row not in [fault.row for fault in faults]:  # else it is what a large turn leaves
            faults.append(Fault(kind, float(size), row, float(turn)))
        found = calibrate_hand_eye(_undone(refitted, motion))
    return faults, found


def _whitened(found: HandEye) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Weighted residuals (n, 6), and slopes by parameters and by the flange, all over noise."""
    linear = LinearHandEye(found)
    # of exact poses, rounding leaves no precision positive definite; covariances are
    covariances = linear.covariances(found.accuracy, found.noise)
    roots = np.linalg.inv(np.linalg.cholesky(covariances))
    roots = roots * np.sqrt(found.weights)[:, None, None]
    residuals = np.einsum("nij,nj->ni", roots, linear.residuals)
    by_flange = roots @ linear.by_flange * np.repeat(found.accuracy, 3)
    return residuals, roots @ linear.slopes, by_flange


def _plainest(found: HandEye, alike: float | None = None) -> Motion:
    """The plainest motion of camera or board.

    Args:
        alike: the correlation of each row with the next; None to try without errors of the flange.
    """
    residuals, slopes, by_flange = _whitened(found)
    corners, rows = found.sights.corners, np.arange(len(residuals))
    known = corners.information.sum(axis=0) + np.diag(corners.deviations**-2.0)
    optics = slopes[..., TARGET.stop :] @ np.linalg.inv(np.linalg.cholesky(known)).T
    others, each = [slopes[..., : TARGET.stop], optics], 1.0
    if alike is not None:
        by_pose = by_flange[..., None] * _deviations(found.sights.flange)[:, None, None]
        others, each = [*others, by_pose.reshape(len(rows), 6, -1)], (1 + alike) / (1 - alike)
    rest = Unexplained(residuals, np.concatenate(others, axis=2), each)
    ends = (CAMERA, TARGET)
    tried = [(*rest.plainest(Candidate("", rows, slopes[..., end], ENDS)), end) for end in ends]
    return max(tried, key=lambda one: one[0])


def _deviations(flange: np.ndarray) -> np.ndarray:
    """Of a flange's poses (n, 4, 4) from their middle (n, 6), over the standard deviations."""
    turns = Rotation.from_matrix(flange[:, :3, :3])
    numbers = np.hstack([flange[:, :3, 3], (turns * turns.mean().inv()).as_rotvec()])
    numbers -= numbers.mean(axis=0)
    return numbers / np.maximum(numbers.std(axis=0), FINEST)


def _undone(found: HandEye, motion: Motion) -> Sights:
    """The sights as if an end had not moved from a row on: the flange did."""
    _, row, by, end = motion
    camera, board, between = found.camera, found.board, found.sights.between.copy()
    if end == CAMERA:
        between[row:] = camera @ np.linalg.inv(displaced(camera, by)) @ between[row:]
    else:
        between[row:] = between[row:] @ displaced(board, by) @ np.linalg.inv(board)
    flange = np.linalg.inv(between) if found.sights.in_hand else between
    return replace(found.sights, flange=flange)
