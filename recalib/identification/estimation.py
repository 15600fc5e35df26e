"""Identification of an arm from measurements: the most probable parameters of an error model.

Let r_i be the residual of measurement i over its noise, and p_j a parameter over its prior standard
deviation. Gauss-Newton minimises

    sum_i rho(|r_i|^2) + sum_j p_j^2 / (2 v_j)

where rho(s) = s / 2 up to a limit and then grows like log(s) (Cauchy's tail): an outlier has almost
no weight. Two more quantities are estimated together with the parameters:

- the noise, from squared residuals over the remaining degrees of freedom (MacKay's evidence);
- the variances v_j, from the data's evidence on each parameter and on their common scale (relevance
  determination). Damage is sparse: most parameters of a damaged arm are still nominal, and one that
  explains nothing is held there. Unknown frames are not damage: their variances are 1.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack
from scipy.special import chdtri

from recalib.errors import BadMeasurement
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import Linearisation
from recalib.identification.model.observations import Observations, check_observations
from recalib.identification.unseen import Unseen

GOOD = 0.99  # the limit of rho is this quantile of the squared residuals of good measurements
DOUBTFUL = 0.3  # measurements with less weight count for no pattern of residuals and no majority
# Degrees of freedom of the prior on the deviations: the fewer, the more the data decide.
SPARSITY = 0.05
# Pseudo-parameters of the expected size that hold the common scale of all parameters.
COMMON = 20.0
WORN = 3.0**2  # the largest variance: wear of three times the expected size
# Pseudo-measurements by which the noises of position and of orientation are assumed to be alike.
SHARED = 10.0
MEDIAN = chdtri(3, 0.5)  # of the squared length of a residual whose components are normal
FIRST_NOISE = 1e-4  # m, rad
LEAST_NOISE = 1e-6  # m, rad: finer than any instrument; exact data would make singular equations
ROBUST_STEPS = 3  # first steps, in which the noise comes from medians, as outliers do not move them
STEPS = 60
# Linearise anew as soon as the square of the motion of the tool by one parameter alone exceeds this
# fraction of the noise. Second-order terms are squares [rad^2] times levers of about a metre, and
# then amount to some hundredths of the noise in all.
NEGLIGIBLE = 0.01
CONVERGED = 0.1  # the last step of parameters, in posterior deviations; relative change of noise


@dataclass(frozen=True)
class Identification:
    """An identified arm: its parameters and their uncertainty.

    Attributes:
        parameters: (P,) of the error model.
        covariance: (P, P) of the parameters' errors.
        noise: (1,) or (2,) standard deviations of a measurement along an axis: position [m],
            orientation [rad].
        weights: (n,) of the measurements: 1, or less for doubtful ones, down to 0.
        log_evidence: of the error model, up to a constant that depends on the data alone. It does
            not include how well known distances and pictures agree with the estimate.
        converged: whether the last step was negligible.
    """

    parameters: np.ndarray
    covariance: np.ndarray
    noise: np.ndarray
    weights: np.ndarray
    log_evidence: float
    converged: bool


def identify(
    model: ErrorModel,
    observations: Observations,
    start: Identification | None = None,
    weights: np.ndarray | None = None,
) -> Identification:
    """The most probable parameters of the model, given the observations.

    Args:
        start: an estimate to start from, for speed; default: the nominal arm. Its model may have
            fewer or more joint terms, but the same frames and the same first terms.
        weights: (n,) of the observations in the first step; default: 1.

    Raises BadMeasurement: no observations, numbers that are not finite, or gross errors.
    """
    check_observations(observations, model.nominal.slides, model.frames)
    scale, kinds = model.deviations, observations.kinds
    parameters, variances = _initial(model, start)
    noise = np.full(kinds, FIRST_NOISE)
    weights = np.ones(len(observations)) if weights is None else weights
    limit = chdtri(3 * kinds, 1 - GOOD)
    terms = model.terms(observations.joints)
    sparse, diagonal = ~model.free, np.diag_indices(len(scale))
    precision = np.empty((len(scale),) * 2)
    linear = Linearisation(model, parameters, observations, terms)
    unseen = Unseen(model, observations)
    for iteration in range(STEPS):
        if not linear.is_good_at(parameters, NEGLIGIBLE * noise.min()):
            del linear  # memory does not suffice for two
            linear = Linearisation(model, parameters, observations, terms)
        if iteration > 0:
            weights = limit / np.maximum(_squares(linear.residuals, noise), limit)
        # The most probable parameters, given noise, weights and variances ...
        information, gradient = linear.normal_equations(weights)
        if unseen.directions.size:
            information = unseen.left_out(unseen.left_out(information).swapaxes(1, 2))
            gradient = unseen.left_out(gradient)
        np.einsum("k,kpq->pq", noise**-2, information, out=precision)
        gradient = noise**-2 @ gradient - parameters / variances
        _add_known(model, parameters, observations, precision, gradient)
        precision[diagonal] += 1 / variances
        try:
            step, step_norm, covariance, volume = _posterior(precision, gradient)
        except np.linalg.LinAlgError:  # a gross error has made the precision singular
            row = weights.argmin()
            valid = "a measurement of the same arm as the others"
            values = observations.joints if observations.measured is None else observations.measured
            raise BadMeasurement(f"measurement {row}", np.ravel(values[row]), valid) from None
        parameters = parameters + step
        linear.move(step)
        # ... and then noise and variances, given the parameters.
        effective_dof = np.einsum("pq,kpq->k", covariance, information) / noise**2
        last_noise, robust = noise, iteration < ROBUST_STEPS
        noise = _noise(linear.residuals, weights, effective_dof, robust)
        common = (COMMON + sparse.sum()) / (COMMON + np.sum(1 / variances[sparse]))
        variances = _variances(model, parameters, np.diag(covariance), common)
        settled = step_norm < CONVERGED and np.allclose(noise, last_noise, rtol=CONVERGED, atol=0)
        if converged := settled and not robust:
            break
    log_evidence = (
        _log_likelihood(linear.residuals, noise, limit)
        + _log_prior(parameters, variances, sparse, common)
        + volume
    )
    return Identification(
        parameters * scale,
        covariance * np.outer(scale, scale),
        noise,
        weights,
        log_evidence,
        bool(converged),
    )


def _posterior(
    precision: np.ndarray, gradient: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray, float]:
    """The step (P,), its norm in posterior deviations, the covariance (P, P), the log volume.

    The precision (P, P) is overwritten: to allocate large matrices takes as long as to fill them.
    Raises LinAlgError: it is singular, or numbers are not finite.
    """
    factor, failed = lapack.dpotrf(precision.T, overwrite_a=True)
    if failed or not (np.isfinite(gradient).all() and np.isfinite(factor).all()):
        raise np.linalg.LinAlgError
    step, _ = lapack.dpotrs(factor, gradient)
    step_norm, volume = float(np.linalg.norm(factor @ step)), -np.log(np.diag(factor)).sum()
    upper, _ = lapack.dpotri(factor, overwrite_c=True)
    covariance = upper + upper.T
    np.fill_diagonal(covariance, np.diag(upper))
    return step, step_norm, covariance, volume


def _initial(model: ErrorModel, start: Identification | None) -> tuple[np.ndarray, np.ndarray]:
    """Initial parameters (P,) over their deviations, and the initial v_j (P,)."""
    scale = model.deviations
    parameters, variances = np.zeros_like(scale), np.ones_like(scale)
    if start is not None:
        known = slice(min(len(scale), len(start.parameters)))
        parameters[known] = start.parameters[known] / scale[known]
        spread = np.ones_like(scale)
        spread[known] = np.diag(start.covariance)[known] / scale[known] ** 2
        variances[known] = _variances(model, parameters, spread, common=1.0)[known]
    return parameters, variances


def _variances(
    model: ErrorModel, parameters: np.ndarray, spread: np.ndarray, common: float
) -> np.ndarray:
    """The most probable v_j, given the parameters (P,) and the variances of their errors (P,)."""
    sparse = (SPARSITY * common + parameters**2 + spread) / (SPARSITY + 1)
    return np.where(model.free, 1, np.minimum(sparse, WORN))


def _add_known(
    model: ErrorModel,
    parameters: np.ndarray,
    observations: Observations,
    precision: np.ndarray,
    gradient: np.ndarray,
) -> None:
    """Add the information of distances, optics and stated frames to the normal equations."""
    centres = model.sockets(parameters * model.deviations)
    for one, other, length, deviation in observations.distances:
        between = centres[one] - centres[other]
        apart = np.linalg.norm(between)
        slope = np.zeros_like(parameters)
        by_centre = slope[model.socket_columns].reshape(-1, 3)
        by_centre[one], by_centre[other] = between / apart, -between / apart
        slope *= model.deviations
        precision += np.outer(slope, slope) / deviation**2
        gradient += slope * (length - apart) / deviation**2
    if observations.optics is not None:
        columns = model.optics_columns
        scale = model.deviations[columns]
        information = observations.optics.information.sum(axis=0) * np.outer(scale, scale)
        precision[columns, columns] += information
        gradient[columns] += observations.optics.gradient.sum(axis=0) * scale
        gradient[columns] -= information @ parameters[columns]
    if model.stated.any():
        precision += model.stated
        gradient -= model.stated @ parameters


def _squares(residuals: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Squared lengths (n,) of the residuals (kind, n, 3) over their noise (kind,)."""
    return np.square(residuals / noise[:, None, None]).sum(axis=(0, 2))


def _log_likelihood(residuals: np.ndarray, noise: np.ndarray, limit: float) -> float:
    squares = _squares(residuals, noise)
    tails = limit * (1 + np.log(np.maximum(squares, limit) / limit))
    losses = np.where(squares <= limit, squares, tails) / 2
    return -losses.sum() - 3 * len(squares) * np.log(noise).sum()


def _log_prior(
    parameters: np.ndarray, variances: np.ndarray, sparse: np.ndarray, common: float
) -> float:
    """The log prior of the parameters, their variances, and the common scale of the variances.

    The variances and their scale have inverse gamma distributions.
    """
    ratio = common / variances[sparse]
    belief = np.sum(np.log(ratio) - ratio + 1) + COMMON * (np.log(common) - common + 1)
    return SPARSITY / 2 * belief - np.sum(parameters**2 / variances + np.log(variances)) / 2


def _noise(
    residuals: np.ndarray, weights: np.ndarray, effective_dof: np.ndarray, robust: bool
) -> np.ndarray:
    """Standard deviations (kind,) of the noise along an axis.

    Args:
        residuals: (kind, n, 3) m and rad.
        weights: (n,) of the measurements; squared, they remove gross outliers entirely.
        effective_dof: (kind,) degrees of freedom that the parameters use.
        robust: whether to use medians, which outliers do not move.
    """
    squares = np.square(residuals).sum(axis=-1)
    if robust:
        count = 3.0 * len(weights)
        total = np.median(squares, axis=1) / MEDIAN * count
    else:
        count = 3 * np.sum(weights**2)
        total = squares @ weights**2
    free = np.maximum(count - effective_dof, 1e-3 * count)
    return np.maximum(
        np.sqrt((total + SHARED * total.sum() / free.sum()) / (free + SHARED)), LEAST_NOISE
    )
