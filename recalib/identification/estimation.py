"""Identification of an arm from where it went: the most probable parameters of an error model.

A residual is what takes the predicted pose to the measured one: translation [m] and turn [rad]
along the base's axes, or the translation alone where no orientation was measured. With r_i the
residual of measurement i over its noise, and p_j a parameter over its prior deviation, Gauss-Newton
minimises

    sum_i rho(|r_i|^2) + sum_j p_j^2 / (2 v_j)

where rho(s) = s / 2 up to a limit and then grows like log(s) (Cauchy's tail), so that a measurement
which is grossly wrong counts for nothing. Estimated along with the parameters are

- the noise, from squared residuals over the degrees of freedom that the parameters leave (MacKay's
  evidence);
- the variances v_j, from what the data say of each parameter and of their common scale (relevance
  determination): damage is sparse, most of what may be wrong with an arm is right, and a parameter
  that explains nothing is held at nominal.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from recalib.identification.error_model import ErrorModel
from recalib.measurements import check_table

DOUBTED = 0.99  # the limit of rho: what lies farther out than this part of good measurements
# Degrees of freedom of the belief in the prior deviations: the fewer, the more the data decide.
SPARSITY = 0.05
# The common scale of all parameters is held by this many more, as large as the model expects.
COMMON = 20.0
# The noise of position and of orientation are believed to be alike, as by so many measurements.
SHARED = 10.0
MEDIAN = chi2.ppf(0.5, 3)  # of the squared length of a residual whose components are normal
FIRST_NOISE = 1e-4  # m, rad
LEAST_NOISE = (
    1e-6  # m, rad: finer than any instrument; without it, exact data make singular equations
)
ROBUST_STEPS = 3  # at the start, in which the noise comes from medians, which outliers do not move
STEPS = 60
# A new linearisation is due where one parameter alone moves the tool so far that its square exceeds
# this part of the noise: second-order terms are squares [rad^2] times levers of about a metre, and
# then reach some hundredths of the noise in all.
NEGLIGIBLE = 0.01
CONVERGED = 0.1  # the last change of parameters, in posterior deviations, and of noise, relative


@dataclass(frozen=True)
class Estimate:
    """What is known of an arm.

    Attributes:
        parameters: (P,) of the error model.
        covariance: (P, P) of their errors.
        noise: (1,) or (2,) standard deviations of a measurement along an axis: position [m],
            orientation [rad].
        weights: (n,) how much each measurement counted: 1, or less if it is doubted, down to 0.
        log_evidence: of the error model, up to a constant that depends on the data alone.
    """

    parameters: np.ndarray
    covariance: np.ndarray
    noise: np.ndarray
    weights: np.ndarray
    log_evidence: float


def displacements(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """What takes poses to others: translation [m] and turn [rad] along the base's axes.

    Args:
        start: (n, 4, 4) poses.
        end: (n, 4, 4) poses, for (n, 6), or (n, 3) positions, for the translations (n, 3) alone.
    """
    if end.ndim == 2:
        return end - start[:, :3, 3]
    between = end[:, :3, :3] @ start[:, :3, :3].swapaxes(1, 2)
    turns = Rotation.from_matrix(between, assume_valid=True).as_rotvec()
    return np.concatenate([end[:, :3, 3] - start[:, :3, 3], turns], axis=-1)


def identify(
    model: ErrorModel, angles: np.ndarray, measured: np.ndarray, start: Estimate | None = None
) -> Estimate:
    """The parameters of the model that explain the measurements.

    Args:
        angles: (n, 6) rad in which the controller believed.
        measured: poses (n, 4, 4) or positions (n, 3) [m] of the tool in the base frame.
        start: an estimate to start from, for speed; the nominal arm unless given. It may be that
            of a model with the same first terms and fewer or more of them.

    Raises BadMeasurement: no numbers, or grossly off; or none at all.
    """
    check_table(angles, measured)
    scale, kinds = model.deviations, 1 if measured.ndim == 2 else 2
    parameters, variances = _initial(scale, start)
    noise, weights = np.full(kinds, FIRST_NOISE), np.ones(len(angles))
    limit = chi2.ppf(DOUBTED, 3 * kinds)
    terms = model.terms(angles)
    origin, reach = np.full_like(scale, np.inf), np.ones_like(scale)  # of the present linearisation
    for step in range(STEPS):
        if np.max(np.abs(parameters - origin) * reach) ** 2 > NEGLIGIBLE * noise.min():
            residuals, jacobians = _linearise(model, parameters, angles, terms, measured)
            origin, reach = parameters, np.abs(jacobians).max(axis=(0, 1, 2))
        if step > 0:
            weights = limit / np.maximum(_squares(residuals, noise), limit)
        # The most probable parameters, given noise, weights and variances ...
        information, pull = _normal_equations(jacobians, residuals, weights)
        precision = np.diag(1 / variances) + np.einsum("k,kpq->pq", noise**-2, information)
        factor = scipy.linalg.cho_factor(precision)
        change = scipy.linalg.cho_solve(factor, noise**-2 @ pull - parameters / variances)
        covariance = scipy.linalg.cho_solve(factor, np.eye(len(scale)))
        parameters = parameters + change
        residuals = residuals - jacobians @ change
        # ... and then noise and variances, given the parameters.
        taken = np.einsum("pq,kpq->k", covariance, information) / noise**2
        last_noise, noise = noise, _noise(residuals, weights, taken, robust=step < ROBUST_STEPS)
        common = (COMMON + len(scale)) / (COMMON + np.sum(1 / variances))
        variances = _variances(parameters, np.diag(covariance), common)
        settled = np.sqrt(change @ precision @ change) < CONVERGED and np.allclose(
            noise, last_noise, rtol=CONVERGED, atol=0
        )
        if settled and step >= ROBUST_STEPS:
            break
    log_evidence = (
        _log_likelihood(residuals, noise, limit)
        + _log_prior(parameters, variances, common)
        - np.log(np.diag(factor[0])).sum()  # the volume that the posterior leaves
    )
    return Estimate(
        parameters * scale, covariance * np.outer(scale, scale), noise, weights, log_evidence
    )


def _initial(scale: np.ndarray, start: Estimate | None) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (P,) over their deviations `scale` (P,) and their variances, to start from."""
    parameters, variances = np.zeros_like(scale), np.ones_like(scale)
    if start is not None:
        known = slice(min(len(scale), len(start.parameters)))
        parameters[known] = start.parameters[known] / scale[known]
        spread = np.diag(start.covariance)[known] / scale[known] ** 2
        variances[known] = _variances(parameters[known], spread, common=1.0)
    return parameters, variances


def _variances(parameters: np.ndarray, spread: np.ndarray, common: float) -> np.ndarray:
    """The most probable v_j, given the parameters (P,) and the variances of their errors (P,)."""
    return (SPARSITY * common + parameters**2 + spread) / (SPARSITY + 1)


def _linearise(
    model: ErrorModel,
    parameters: np.ndarray,
    angles: np.ndarray,
    terms: np.ndarray,
    measured: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Residuals (n, kind, 3) and Jacobians (n, kind, 3, P) of the predictions.

    Parameters are those over their deviations.
    """
    poses, jacobians = model.linearise(parameters * model.deviations, angles, terms)
    residuals = displacements(poses, measured).reshape(len(angles), -1, 3)
    rows = jacobians[:, : 3 * residuals.shape[1]] * model.deviations
    return residuals, rows.reshape(*residuals.shape, -1)


def _squares(residuals: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Squared lengths (n,) of the residuals (n, kind, 3) over their noise (kind,)."""
    return np.square(residuals / noise[:, None]).sum(axis=(1, 2))


def _log_likelihood(residuals: np.ndarray, noise: np.ndarray, limit: float) -> float:
    squares = _squares(residuals, noise)
    tails = limit * (1 + np.log(np.maximum(squares, limit) / limit))
    losses = np.where(squares <= limit, squares, tails) / 2
    return -losses.sum() - 3 * len(residuals) * np.log(noise).sum()


def _log_prior(parameters: np.ndarray, variances: np.ndarray, common: float) -> float:
    """Of the parameters given their variances, of these given their common scale, and of that.

    The variances and their scale have inverse gamma distributions.
    """
    ratio = common / variances
    belief = np.sum(np.log(ratio) - ratio + 1) + COMMON * (np.log(common) - common + 1)
    return SPARSITY / 2 * belief - np.sum(parameters**2 / variances + np.log(variances)) / 2


def _normal_equations(
    jacobians: np.ndarray, residuals: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """J' W J (kind, P, P) and J' W r (kind, P).

    Args:
        jacobians: (n, kind, 3, P) of the measured coordinates by the parameters.
        residuals: (n, kind, 3) of the measurements.
        weights: (n,) theirs.
    """
    roots = np.sqrt(weights)[:, None, None]
    jacobians = (
        (jacobians * roots[..., None])
        .swapaxes(0, 1)
        .reshape(jacobians.shape[1], -1, jacobians.shape[-1])
    )
    residuals = (residuals * roots).swapaxes(0, 1).reshape(len(jacobians), -1, 1)
    transposed = jacobians.swapaxes(1, 2)
    return transposed @ jacobians, (transposed @ residuals)[..., 0]


def _noise(
    residuals: np.ndarray, weights: np.ndarray, taken: np.ndarray, robust: bool
) -> np.ndarray:
    """Standard deviations (kind,) of the noise along an axis.

    Args:
        residuals: (n, kind, 3) m and rad.
        weights: (n,) of the measurements; their squares leave nothing of a gross outlier.
        taken: (kind,) degrees of freedom that the parameters use.
        robust: to go by medians, which outliers do not move.
    """
    squares = np.square(residuals).sum(axis=-1)
    if robust:
        count = 3.0 * len(squares)
        total = np.median(squares, axis=0) / MEDIAN * count
    else:
        count = 3 * np.sum(weights**2)
        total = weights**2 @ squares
    free = np.maximum(count - taken, 1e-3 * count)
    return np.maximum(
        np.sqrt((total + SHARED * total.sum() / free.sum()) / (free + SHARED)), LEAST_NOISE
    )
