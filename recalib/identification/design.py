"""Which pose to measure next: the one that would teach the most (D-optimal design)."""

import numpy as np

from recalib.identification.calibration import Calibration


def information_gains(calibration: Calibration, joints: np.ndarray) -> np.ndarray:
    """What a measurement at each of several postures would tell of the arm, (n,) in nats.

    It is the logarithm of the factor by which the volume of the parameters' uncertainty would
    shrink: what D-optimal designs maximise.

    Args:
        calibration: what is known.
        joints: (n, joints) rad, m, each for one pose.
    """
    model, estimate = calibration.model, calibration.estimate
    kinds = len(estimate.noise)
    _, jacobians = model.linearise(estimate.parameters, joints, model.terms(joints))
    scaled = jacobians[:, : 3 * kinds] / np.repeat(estimate.noise, 3)[:, None]
    spread = scaled @ estimate.covariance @ scaled.swapaxes(1, 2)
    return np.linalg.slogdet(np.eye(3 * kinds) + spread).logabsdet / 2
