"""Robust identification where many rows are outliers, up to a third and more.

An identification that starts from all rows may end between good rows and outliers and take the
distance for noise. So, if the noise is suspiciously large, it also starts from many small sets of
rows, some of them without outliers (Rousseeuw 1984, Least median of squares regression). A start
that finds far less noise in most rows is accepted, if these are more rows than a model could fit by
chance.
"""

import numpy as np

from recalib.identification.estimation import DOUBTFUL, Identification, identify
from recalib.identification.model.error_model import ErrorModel
from recalib.identification.model.linearisation import LEVER, Linearisation
from recalib.identification.model.observations import Observations
from recalib.numerics.randomness import generator

SUSPICIOUS = 1e-3  # m along an axis: few instruments are so bad
SETS, BEST = 100, 3  # small sets of rows, and how many of them are gone on from
FEW = {1: 10, 2: 6}  # rows of a small set, of positions and of poses
GROSS = 3.0  # times the median error: such a row is left out at the start
MOST = 0.6  # the part of rows that must not be doubted
AMPLE = 1.5  # times the numbers that can be fitted by chance
CLEARLY = 0.3  # of the noise that was found before


def identify_by_consensus(model: ErrorModel, observations: Observations) -> Identification:
    """As `identify`; see above.

    Raises BadMeasurement, as `identify`.
    """
    found = identify(model, observations)
    size = FEW[observations.kinds]
    if found.noise[0] < SUSPICIOUS or len(observations) <= size:
        return found
    rng, terms = generator(0, "consensus"), model.terms(observations.joints)
    # so many numbers an arm can fit exactly: 4 for each joint, 6 for its ends
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
