"""Choice of the most informative postures to measure next (D-optimal design)."""

from collections.abc import Iterator

import numpy as np

from recalib.arrays import array_of
from recalib.errors import check_kind
from recalib.identification.calibration import Calibration
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import Optics


def information_gains(calibration: Calibration, joints: np.ndarray) -> np.ndarray:
    """The information gained by a measurement at each of several postures, (n,) in nats.

    A gain is the logarithm of the factor by which the volume of the parameters' uncertainty would
    shrink. D-optimal designs maximise it. Each row of joints (n, joints) [rad, m] stands for one
    measurement of the first target.

    Raises InvalidSetting: another shape, or an object that is not a calibration.
    """
    check_kind("calibration", calibration, Calibration)
    joints = array_of("joints", joints, ("n", len(calibration.model.nominal.joints)))
    if not len(joints):
        return np.zeros(0)
    return _gains(_spreads(_rows(calibration, joints), calibration.estimate.covariance))


def surprises(calibration: Calibration, observations: Observations) -> np.ndarray:
    """Normalised squared prediction errors (n,) of new measurements of the first target.

    It is the mean square of the errors over the covariance of prediction and measurement (the
    normalised innovation of a Kalman filter): about 1 if model and noise are right.
    """
    rows = _rows(calibration, observations.joints, observations.optics)
    noise = np.repeat(calibration.estimate.noise, 3)
    residuals = calibration.residuals(observations)
    off = observations.whitened(residuals)[:, : len(noise)] / noise
    spreads = _spreads(rows, calibration.estimate.covariance)
    return np.einsum("ni,ni->n", off, np.linalg.solve(spreads, off[..., None])[..., 0]) / len(noise)


def most_informative(
    calibration: Calibration, joints: np.ndarray, count: int, optics: Optics | None = None
) -> Iterator[tuple[int, np.ndarray]]:
    """Up to `count` postures, chosen greedily: each has the largest gain after those before it.

    `optics` belong to the pictures that would be taken there; None without cameras. Yields the
    number of each posture, and the covariance (P, P) of the parameters after its measurement.
    """
    rows, covariance = _rows(calibration, joints, optics), calibration.estimate.covariance
    unused = np.ones(len(rows), dtype=bool)
    for _ in range(min(count, len(rows))):
        spreads = _spreads(rows, covariance)
        best = int(np.where(unused, _gains(spreads), -np.inf).argmax())
        unused[best] = False
        across = rows[best] @ covariance
        covariance = covariance - across.T @ np.linalg.solve(spreads[best], across)  # Woodbury
        yield best, covariance


def _rows(calibration: Calibration, joints: np.ndarray, optics: Optics | None = None) -> np.ndarray:
    """Jacobians (n, 3 or 6, P) of the measured quantities, over their noise."""
    model, estimate = calibration.model, calibration.estimate
    noise = np.repeat(estimate.noise, 3)
    _, jacobians = model.linearise(estimate.parameters, joints)
    if optics is not None:
        jacobians[..., model.optics_columns] = -optics.slopes
        jacobians = Observations(joints, optics=optics).whitened(jacobians)
    return jacobians[:, : len(noise)] / noise[:, None]


def _spreads(rows: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Covariances (n, 3 or 6, 3 or 6) of predicted measurements, over the noise's covariance."""
    return np.eye(rows.shape[1]) + rows @ covariance @ rows.swapaxes(1, 2)


def _gains(spreads: np.ndarray) -> np.ndarray:
    return np.linalg.slogdet(spreads).logabsdet / 2
