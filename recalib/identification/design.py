"""Which pose to measure next: the one that would teach the most (D-optimal design)."""

import numpy as np

from recalib.identification.calibration import Calibration


def information_gains(calibration: Calibration, angles: np.ndarray) -> np.ndarray:
    """What a measurement of the pose at each of the joint angles (n, 6) [rad] would tell of the parameters, (n,) nats.

    By so much the volume of the parameters' uncertainty would shrink, on a logarithmic scale: the determinant that D-optimal
    designs maximise.
    """
    model, estimate = calibration.model, calibration.estimate
    kinds = len(estimate.noise)
    _, jacobians = model.linearise(estimate.parameters, angles, model.terms(angles))
    scaled = jacobians[:, : 3 * kinds] / np.repeat(estimate.noise, 3)[:, None]
    spread = scaled @ estimate.covariance @ scaled.swapaxes(1, 2)
    return np.linalg.slogdet(np.eye(3 * kinds) + spread).logabsdet / 2
