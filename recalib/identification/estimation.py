"""Identification of an arm from where it went: the most probable parameters of an error model.

With r_i the residual of measurement i over its noise, and p_j a parameter over its prior deviation,
Gauss-Newton minimises

    sum_i rho(|r_i|^2) + sum_j p_j^2 / (2 v_j)

where rho(s) = s / 2 up to a limit and then grows like log(s) (Cauchy's tail), so that a measurement
which is grossly wrong counts for nothing. Estimated along with the parameters are

- the noise, from squared residuals over the degrees of freedom that the parameters leave (MacKay's
  evidence);
- the variances v_j, from what the data say of each parameter and of their common scale (relevance
  determination): damage is sparse, most of what may be wrong with an arm is right, and a parameter
  that explains nothing is held at nominal. Frames that nobody knows are no damage: theirs are 1.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.special import chdtri

from recalib.errors import BadMeasurement
from recalib.identification.checks import check_observations
from recalib.identification.error_model import ErrorModel
from recalib.identification.linearised import Linearised
from recalib.identification.observations import Observations

GOOD = 0.99  # the limit of rho: what lies farther out than this part of good measurements
DOUBTFUL = 0.3  # the weight of a measurement below which it is no part of a pattern or a majority
# Degrees of freedom of the belief in the prior deviations: the fewer, the more the data decide.
SPARSITY = 0.05
# The common scale of all parameters is held by this many more, as large as the model expects.
COMMON = 20.0
# The noise of position and of orientation are believed to be alike, as by so many measurements.
SHARED = 10.0
MEDIAN = chdtri(3, 0.5)  # of the squared length of a residual whose components are normal
FIRST_NOISE = 1e-4  # m, rad
LEAST_NOISE = 1e-6  # m, rad: finer than any instrument; exact data would make singular equations
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
        converged: whether the last step changed next to nothing.
    """

    parameters: np.ndarray
    covariance: np.ndarray
    noise: np.ndarray
    weights: np.ndarray
    log_evidence: float
    converged: bool


def identify(
    model: ErrorModel,
    seen: Observations,
    start: Estimate | None = None,
    weights: np.ndarray | None = None,
) -> Estimate:
    """The parameters of the model that explain what was seen.

    Args:
        start: an estimate to start from, for speed; the nominal arm unless given. It may be that
            of a model with the same frames, the same first terms and fewer or more of them.
        weights: (n,) of the observations in the first step; all count unless given.

    Raises BadMeasurement: no numbers, or grossly off; or none at all.
    """
    check_observations(seen, model)
    scale, kinds = model.deviations, seen.kinds
    parameters, variances = _initial(model, start)
    noise = np.full(kinds, FIRST_NOISE)
    weights = np.ones(len(seen)) if weights is None else weights
    limit = chdtri(3 * kinds, 1 - GOOD)
    terms = model.terms(seen.joints)
    sparse, diagonal, near = ~model.free, np.diag_indices(len(scale)), None
    precision = np.empty((len(scale),) * 2)
    for step in range(STEPS):
        if near is None or not near.is_good_at(parameters, NEGLIGIBLE * noise.min()):
            near = None  # of two there is no room for
            near = Linearised(model, parameters, seen, terms)
        if step > 0:
            weights = limit / np.maximum(_squares(near.residuals, noise), limit)
        # The most probable parameters, given noise, weights and variances ...
        information, pull = near.normal_equations(weights)
        np.einsum("k,kpq->pq", noise**-2, information, out=precision)
        pull = noise**-2 @ pull - parameters / variances
        if seen.distances:
            known, stretch = _distances(model, parameters, seen)
            precision += known
            pull += stretch
        precision[diagonal] += 1 / variances
        try:
            change, length, covariance, volume = _posterior(precision, pull)
        except ValueError:  # what is far off has led to where nothing can be told any more
            row = weights.argmin()
            valid = "what the same arm explains as the others"
            numbers = seen.joints[row] if seen.measured is None else np.ravel(seen.measured[row])
            raise BadMeasurement(f"measurement {row}", numbers, valid) from None
        parameters = parameters + change
        near.move(change)
        # ... and then noise and variances, given the parameters.
        taken = np.einsum("pq,kpq->k", covariance, information) / noise**2
        last_noise, noise = (
            noise,
            _noise(near.residuals, weights, taken, robust=step < ROBUST_STEPS),
        )
        common = (COMMON + sparse.sum()) / (COMMON + np.sum(1 / variances[sparse]))
        variances = _variances(model, parameters, np.diag(covariance), common)
        settled = length < CONVERGED and np.allclose(noise, last_noise, rtol=CONVERGED, atol=0)
        if converged := settled and step >= ROBUST_STEPS:
            break
    log_evidence = (
        _log_likelihood(near.residuals, noise, limit)
        + _log_prior(parameters, variances, sparse, common)
        + volume
    )
    return Estimate(
        parameters * scale,
        covariance * np.outer(scale, scale),
        noise,
        weights,
        log_evidence,
        bool(converged),
    )


def _posterior(
    precision: np.ndarray, pull: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray, float]:
    """The change of the parameters (P,) for a pull (P,), and what is left unknown of them.

    The precision (P, P) is overwritten: to find room for large matrices takes as long as to fill
    them.

    Returns the change, its length in posterior deviations, the covariance (P, P), and the logarithm
    of the volume that the posterior leaves.
    """
    factor = scipy.linalg.cholesky(precision.T, overwrite_a=True)
    change = scipy.linalg.cho_solve((factor, False), pull)
    length, volume = np.linalg.norm(factor @ change), -np.log(np.diag(factor)).sum()
    upper, _ = scipy.linalg.lapack.dpotri(factor, overwrite_c=True)
    covariance = upper + upper.T
    np.fill_diagonal(covariance, np.diag(upper))
    return change, length, covariance, volume


def _initial(model: ErrorModel, start: Estimate | None) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (P,) over their deviations and their variances, to start from."""
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
    return np.where(model.free, 1, sparse)


def _distances(
    model: ErrorModel, parameters: np.ndarray, seen: Observations
) -> tuple[np.ndarray, np.ndarray]:
    """What known distances between sockets add to the normal equations: (P, P) and (P,)."""
    information, pull = np.zeros((len(parameters),) * 2), np.zeros(len(parameters))
    centres = model.sockets(parameters * model.deviations)
    for one, other, length, deviation in seen.distances:
        between = centres[one] - centres[other]
        apart = np.linalg.norm(between)
        slope = np.zeros_like(parameters)
        by_centre = slope[model.socket_columns].reshape(-1, 3)
        by_centre[one], by_centre[other] = between / apart, -between / apart
        slope *= model.deviations
        information += np.outer(slope, slope) / deviation**2
        pull += slope * (length - apart) / deviation**2
    return information, pull


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
    """Of the parameters given their variances, of these given their common scale, and of that.

    The variances and their scale have inverse gamma distributions.
    """
    ratio = common / variances[sparse]
    belief = np.sum(np.log(ratio) - ratio + 1) + COMMON * (np.log(common) - common + 1)
    return SPARSITY / 2 * belief - np.sum(parameters**2 / variances + np.log(variances)) / 2


def _noise(
    residuals: np.ndarray, weights: np.ndarray, taken: np.ndarray, robust: bool
) -> np.ndarray:
    """Standard deviations (kind,) of the noise along an axis.

    Args:
        residuals: (kind, n, 3) m and rad.
        weights: (n,) of the measurements; their squares leave nothing of a gross outlier.
        taken: (kind,) degrees of freedom that the parameters use.
        robust: to go by medians, which outliers do not move.
    """
    squares = np.square(residuals).sum(axis=-1)
    if robust:
        count = 3.0 * len(weights)
        total = np.median(squares, axis=1) / MEDIAN * count
    else:
        count = 3 * np.sum(weights**2)
        total = squares @ weights**2
    free = np.maximum(count - taken, 1e-3 * count)
    return np.maximum(
        np.sqrt((total + SHARED * total.sum() / free.sum()) / (free + SHARED)), LEAST_NOISE
    )
