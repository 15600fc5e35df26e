"""How well an arm returns to a posture, beside how well a camera sees it.

Corners tell some directions of a pose a hundred times better than others. If the arm itself does
not return as well, the surest directions are less sure than they look. So both are weighed: each
pose has the covariance of its corners and, in addition, that of the arm, whose size is the most
probable of a few.
"""

from dataclasses import replace

import numpy as np

from recalib.identification.estimation import identify
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import LEVER
from recalib.identification.model.observations import Observations

# Of displacements [m, rad], for a rad by which joints do not return.
COVARIANCE = np.diag([LEVER**2] * 3 + [1.0] * 3)
RETURNS = 3e-5, 1e-4, 3e-4, 1e-3  # rad: from what hardly an arm does better to a worn one


def weigh(model: ErrorModel, observations: Observations, some: slice = slice(None)) -> Observations:
    """The same observations, whose optics take into account how well the arm returns.

    Args:
        some: rows by which that is judged: all take long if they are many.

    Raises BadMeasurement, as `identify`.
    """
    assert observations.optics is not None
    tried = []
    for returns in RETURNS:
        optics = observations.optics.with_noise(returns**2 * COVARIANCE)
        weighed = replace(observations, optics=optics)
        # a density of residuals before they were whitened
        volume = np.linalg.slogdet(optics.whitening[some]).logabsdet.sum()
        tried.append((identify(model, weighed[some]).log_evidence + volume, -returns, weighed))
    return max(tried, key=lambda one: one[:2])[2]
