"""Robust identification from data with many outliers, up to a third of the rows and more.

An identification that starts from all rows may end between good rows and outliers and mistake their
distance for noise. So, if the noise is suspiciously large, it also starts from many small sets of
rows, some of them without outliers (Rousseeuw 1984, Least median of squares regression). The result
of a start is accepted if it has far less noise in most rows, and if these are more rows than a
model could fit by chance.
"""

import numpy as np

from recalib.identification.estimation import DOUBTFUL, Identification, identify
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import LEVER, Linearisation
from recalib.identification.model.observations import Observations
from recalib.numerics.randomness import generator

SUSPICIOUS = 1e-3  # m along an axis: few instruments are so noisy
SETS, BEST = 100, 3  # the number of small sets of rows, and of the best to continue from
FEW = {1: 10, 2: 6}  # rows in a small set, of positions and of poses
GROSS = 3.0  # times the median error: rows beyond it are left out at the start
MOST = 0.6  # the least fraction of rows that are not doubtful
AMPLE = 1.5  # margin on the count of numbers that a model can fit by chance
CLEARLY = 0.3  # a new result must have less than this fraction of the noise before it


def identify_by_consensus(model: ErrorModel, observations: Observations) -> Identification:
    """The estimate of `identify`, or that of a start from few rows if it has far less noise.

    Raises BadMeasurement, as `identify`.
    """
    found = identify(model, observations)
    size = FEW[observations.kinds]
    if found.noise[0] < SUSPICIOUS or len(observations) <= size:
        return found
    rng, terms = generator(0, "consensus"), model.terms(observations.joints)
    # an arm can fit 4 numbers for each joint and 6 for its ends exactly
    by_chance = AMPLE * (4 * len(model.nominal.slides) + 6)
    starts = []
    for number in range(SETS):
        start = identify(model, observations[rng.permutation(len(observations))[:size]])
        parameters = start.parameters / model.deviations
        residuals = Linearisation(model, parameters, observations, terms).residuals
        levers = np.array([1, LEVER])[: observations.kinds, None, None]
        errors = np.sqrt(np.square(residuals * levers).sum(axis=(0, 2)))
        starts.append((np.median(errors), number, start, errors))
    for median, _, start, errors in sorted(starts, key=lambda one: one[:2])[:BEST]:
        other = identify(model, observations, start, (errors < GROSS * median).astype(float))
        counted = np.sum(other.weights > DOUBTFUL)
        enough = max(MOST * len(observations), by_chance / (3 * observations.kinds))
        if counted > enough and other.noise[0] < CLEARLY * found.noise[0]:
            found = other
    return found
