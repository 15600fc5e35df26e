"""The most informative postures to measure next (D-optimal design)."""

from collections.abc import Iterator

import numpy as np

from recalib.arrays import array_of
from recalib.errors import check_kind
from recalib.identification.calibration import Calibration
from recalib.identification.model.observations import Observations
from recalib.identification.model.optics import Optics


def information_gains(calibration: Calibration, joints: np.ndarray) -> np.ndarray:
    """The information gained by a measurement at each of several postures, (n,) in nats.

    It is the logarithm of the factor by which the volume of the parameters' uncertainty would
    shrink: what D-optimal designs maximise. Joints (n, joints) [rad, m] are each for one
    measurement of the first target.

    Raises InvalidSetting: another shape, something else than a calibration.
    """
    check_kind("calibration", calibration, Calibration)
    joints = array_of("joints", joints, ("n", len(calibration.model.nominal.joints)))
    if not len(joints):
        return np.zeros(0)
    return _gains(_spreads(_rows(calibration, joints), calibration.estimate.covariance))


def surprises(calibration: Calibration, observations: Observations) -> np.ndarray:
    """How unexpected measurements of the first target are (n,), of which none was learned from.

    The mean square of the prediction errors, over the covariance of both (the
    normalised innovation of a Kalman filter): about 1 where model and noise are right.
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
    """At most `count` different postures of the largest gains, each given those before it.

    Optics are of the pictures that would be taken there; None if no cameras measure. Yields each
    one's number, and the covariance (P, P) of the parameters once it is measured.
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
