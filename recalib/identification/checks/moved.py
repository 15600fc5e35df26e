"""Detection of a camera, a board or a flange frame that moved during a hand-eye calibration.

The search is that of `sequence`, but without a model of the arm, whose errors vary along a path and
resemble a motion. So the motion is undone, and a fit without it shows the noise. The motion must
then be significant again, next to errors of the flange that are linear in its pose and as large as
this noise. Rows count less if the residuals of successive rows are correlated.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.checks.sequence import (
    JUMP,
    MOST,
    SHARE,
    SLIP,
    Candidate,
    Fault,
    Unexplained,
    jumps,
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

Motion = tuple[float, np.ndarray, np.ndarray, slice]  # share, window, displacement (6,), which end


def moved_ends(found: HandEye) -> tuple[list[Fault], HandEye]:
    """Jumps of the object next to the arm, slips of that on the flange, and a fit without them."""
    faults: list[Fault] = []
    for _ in range(MOST):
        motion = _strongest(found)
        if motion[0] < SHARE:
            break
        without = calibrate_hand_eye(_undone(found, motion))
        residuals, _, _ = LinearHandEye(without).whitened()
        correlation = max(0.0, np.sum(residuals[1:] * residuals[:-1]) / np.sum(residuals**2))
        refitted = replace(without, sights=found.sights)
        share, (row, _), step, end = motion = _strongest(refitted, correlation)
        if share < SHARE:
            break
        kind = SLIP if found.sights.in_hand == (end == CAMERA) else JUMP
        size, turn = np.linalg.norm(step.reshape(2, 3), axis=1)
        if row not in [fault.row for fault in faults]:  # else it is the remainder of a large turn
            faults.append(Fault(kind, float(size), int(row), float(turn)))
        found = calibrate_hand_eye(_undone(refitted, motion))
    return faults, found


def _strongest(found: HandEye, correlation: float | None = None) -> Motion:
    """The most significant motion of camera or board.

    Args:
        correlation: of each row with the next; None to search without errors of the flange.
    """
    residuals, slopes, by_flange = LinearHandEye(found).whitened()
    corners, rows = found.sights.corners, np.arange(len(residuals))
    known = corners.information.sum(axis=0) + np.diag(corners.deviations**-2.0)
    optics = slopes[..., TARGET.stop :] @ np.linalg.inv(np.linalg.cholesky(known)).T
    others, redundancy = [slopes[..., : TARGET.stop], optics], 1.0
    if correlation is not None:
        by_pose = by_flange[..., None] * _deviations(found.sights.flange)[:, None, None]
        others = [*others, by_pose.reshape(len(rows), 6, -1)]
        redundancy = (1 + correlation) / (1 - correlation)
    rest = Unexplained(residuals, np.concatenate(others, axis=2), redundancy)
    ends = (CAMERA, TARGET)
    windows = jumps(len(rows))
    tried = [(*rest.strongest(Candidate("", rows, slopes[..., end], windows)), end) for end in ends]
    return max(tried, key=lambda motion: motion[0])


def _deviations(flange: np.ndarray) -> np.ndarray:
    """Deviations (n, 6) of a flange's poses (n, 4, 4) from their mean, standardised."""
    turns = Rotation.from_matrix(flange[:, :3, :3])
    numbers = np.hstack([flange[:, :3, 3], (turns * turns.mean().inv()).as_rotvec()])
    numbers -= numbers.mean(axis=0)
    return numbers / np.maximum(numbers.std(axis=0), FINEST)


def _undone(found: HandEye, motion: Motion) -> Sights:
    """The sights as if the end had not moved, with the motion undone in the flange's poses."""
    _, (row, _), step, end = motion
    camera, board, between = found.camera, found.board, found.sights.between.copy()
    if end == CAMERA:
        between[row:] = camera @ np.linalg.inv(displaced(camera, step)) @ between[row:]
    else:
        between[row:] = between[row:] @ displaced(board, step) @ np.linalg.inv(board)
    flange = np.linalg.inv(between) if found.sights.in_hand else between
    return replace(found.sights, flange=flange)
