"""How well an arm returns to a posture, apart from how well a camera sees it.

Corners tell some directions of a pose a hundred times better than others. If the arm itself does
not return as well, the surest directions are less sure than they look. So both are weighed: each
pose has the covariance of its corners and, in addition, that of the arm, whose size is the most
probable of a few.
"""

import numpy as np

from recalib.identification.estimation import identify
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations

# Of displacements [m, rad], for a rad by which joints do not return.
COVARIANCE = np.diag([LEVER**2] * 3 + [1.0] * 3)
RETURNS = 3e-5, 1e-4, 3e-4, 1e-3  # rad: from what hardly an arm does better to a worn one


def returning(model: ErrorModel, observations: Observations) -> np.ndarray:
    """The covariance (6, 6) [m, rad] by which the arm does not return to a posture.

    Raises BadMeasurement, as `identify`.
    """
    tried = []
    for size in RETURNS:
        covariance = size**2 * COVARIANCE
        weighed = observations.with_noise(covariance)
        assert weighed.optics is not None
        # a density of residuals before they were whitened
        volume = np.linalg.slogdet(weighed.optics.whitening).logabsdet.sum()
        evidence = identify(model, weighed).log_evidence
        tried.append((evidence + volume, -size, covariance))
    return max(tried, key=lambda one: one[:2])[2]
