"""How far errors of the arm that vary smoothly with its pose may move camera and board."""

from dataclasses import replace

import numpy as np
from scipy.linalg import orth
from scipy.spatial.distance import cdist

from recalib.identification.model.hand_eye_model import ENDS, HandEye, LinearHandEye
from recalib.identification.model.linearisation import LEVER, crosses

# How slowly smooth errors vary. Simulated UR5, UR10 and Panda determine it: the likelihood cannot,
# since camera and board absorb what is common to all poses, which is most of such errors.
SLOWLY = 4.0
SIZES = np.concatenate([[0.0], np.geomspace(1e-7, 1.0, 71)])  # m
AKAIKE = 2.0  # by how much -2 log(likelihood) must fall for smooth errors to count
SOME = 200  # poses at which such errors are described; in between they are interpolated
NEGLIGIBLE = 1e-4  # of the largest eigenvalue
LOOSE = 1e-3  # of the largest singular value: smaller ones leave a direction undetermined


def with_smooth_errors(found: HandEye) -> HandEye:
    """The same, with a covariance that allows for errors that vary smoothly with the pose.

    Offsets of joints and wrong lengths of links act as if base and flange moved with the pose:

        r_i = A_i (x + B d_i) + e_i,    cov(d_i, d_j) = s^2 exp(-|f_i - f_j|^2 / (2 SLOWLY^2)) I.

    x are the poses of camera and board, A_i the slopes by them, and e_i the noise. d_i are
    displacements of both frames, with turns times LEVER, and B maps them to what is in the frames.
    f_i is the flange's position over LEVER and its rotation matrix over sqrt(2), so that small
    turns count in rad. s and a factor of the noise's covariances C_i maximise the restricted
    likelihood, if Akaike's criterion prefers s > 0. The covariance of P sum A_i' C_i^-1 A_i B d_i,
    the error of x that d_i cause, is added to P, the covariance without d_i.
    """
    residuals, slopes, _ = LinearHandEye(found).whitened()
    rows, fields = slopes.reshape(residuals.size, -1), _fields(found.sights.flange)
    by_frames = slopes[..., :ENDS] @ _to_ends(found)
    moved = np.einsum("nij,nk->nijk", by_frames, fields).reshape(residuals.size, -1)
    lengths = np.maximum(np.linalg.norm(rows, axis=0), np.finfo(float).tiny)
    fitted = orth(rows / lengths, rcond=LOOSE)
    rest, unfitted = (each - fitted @ (fitted.T @ each) for each in (residuals.ravel(), moved))
    directions, sizes, _ = np.linalg.svd(unfitted, full_matrices=False)
    along, freedom = directions.T @ rest, residuals.size - fitted.shape[1]
    growth = 1 + np.outer(SIZES**2, sizes**2)
    noise = np.sum(along**2 / growth, axis=1) + np.sum((rest - directions @ along) ** 2)
    unlikelihood = np.log(growth).sum(axis=1) + freedom * np.log(noise)
    best = np.argmin(unlikelihood + AKAIKE * (SIZES > 0))
    shifts = found.covariance[:ENDS] @ (rows.T @ moved)
    covariance = found.covariance.copy()
    covariance[:ENDS, :ENDS] += SIZES[best] ** 2 * noise[best] / freedom * shifts @ shifts.T
    return replace(found, covariance=covariance)


def _fields(flange: np.ndarray) -> np.ndarray:
    """Values (n, k) at poses (n, 4, 4) of independent fields that vary smoothly with the pose."""
    turns = flange[:, :3, :3].reshape(-1, 9) / np.sqrt(2)
    features = np.hstack([flange[:, :3, 3] / LEVER, turns])
    some = np.unique(np.linspace(0, len(features) - 1, SOME).astype(int))
    alike = np.exp(-cdist(features, features[some], "sqeuclidean") / (2 * SLOWLY**2))
    strengths, shapes = np.linalg.eigh(alike[some])
    kept = strengths > NEGLIGIBLE * strengths[-1]
    return alike @ shapes[:, kept] / np.sqrt(strengths[kept])


def _to_ends(found: HandEye) -> np.ndarray:
    """B (12, 12), from displacements of the frames to those of camera and board in them."""
    to_ends = np.diag(np.tile(np.repeat([1.0, 1 / LEVER], 3), 2))
    to_ends[:3, 3:6] = -crosses(found.camera[:3, 3])[0] / LEVER
    to_ends[6:9, 9:] = -crosses(found.board[:3, 3])[0] / LEVER
    return to_ends
