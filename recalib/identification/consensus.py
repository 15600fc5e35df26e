"""An identification that survives where many rows are grossly wrong, up to a third and more.

One that starts from all rows may settle between good ones and bad ones and take the distance for
noise. So, where the noise is suspicious, it is started from many small sets of rows, too, some of
which hold good ones alone (Rousseeuw 1984, Least median of squares regression). What finds far less
noise in most of the rows is right, if these are more than a model could fit by chance.
"""

import numpy as np

from recalib.identification.error_model import ErrorModel
from recalib.identification.estimation import DOUBTFUL, Estimate, identify
from recalib.identification.linearised import LEVER, Linearised
from recalib.identification.observations import Observations
from recalib.randomness import generator

SUSPICIOUS = 1e-3  # m along an axis: few instruments are so bad
SETS, BEST = 100, 3  # small sets of rows, and how many of them are gone on from
FEW = {1: 10, 2: 6}  # rows of a small set, of positions and of poses
GROSS = 3.0  # times the median of what is missed: such a row is left out at the start
MOST = 0.6  # the part of rows that must not be doubted
AMPLE = 1.5  # times the numbers that can be fitted by chance
CLEARLY = 0.3  # of the noise that was found before


def identify_by_consensus(model: ErrorModel, seen: Observations) -> Estimate:
    """As `identify`; see above.

    Raises BadMeasurement, as `identify`.
    """
    found = identify(model, seen)
    size = FEW[seen.kinds]
    if found.noise[0] < SUSPICIOUS or len(seen) <= size:
        return found
    random, terms = generator(0, "consensus"), model.terms(seen.joints)
    starts = []
    for number in range(SETS):
        start = identify(model, seen[random.permutation(len(seen))[:size]])
        near = Linearised(model, start.parameters / model.deviations, seen, terms)
        levers = np.array([1, LEVER])[: seen.kinds, None, None]
        missed = np.sqrt(np.square(near.residuals * levers).sum(axis=(0, 2)))
        starts.append((np.median(missed), number, start, missed))
    for median, _, start, missed in sorted(starts, key=lambda one: one[:2])[:BEST]:
        other = identify(model, seen, start, (missed < GROSS * median).astype(float))
        counted = np.sum(other.weights > DOUBTFUL)
        enough = counted > MOST * len(seen) and 3 * seen.kinds * counted > _by_chance(model)
        if enough and other.noise[0] < CLEARLY * found.noise[0]:
            found = other
    return found


def _by_chance(model: ErrorModel) -> float:
    """How many numbers an arm could fit whatever they are: 4 for each joint, 6 for its ends."""
    return AMPLE * (4 * len(model.nominal.slides) + 6)
