"""Expected learning of a cell in one iteration (section 6): equation (10) against Monte Carlo."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from recalib.learners.schedules import DIMENSIONS, expected_learning
from recalib.numerics.randomness import generator

WIDTHS = (0.1, 0.15, 0.2, 0.3, 0.5, 1.0)  # of the neighbourhood, in workspace coordinates
DISTANCES = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0)  # from a face; the centre is at 1
SAMPLES = 1_000_000


def visits(
    seed: int,
    widths: Sequence[float] = WIDTHS,
    distances: Sequence[float] = DISTANCES,
    samples: int = SAMPLES,
) -> pd.DataFrame:
    """The ratio of simulated L to L in (10), for cells at `distances` from a face of the workspace.

    `widths` are widths of the neighbourhood; `samples` is the number of random winners. The centre
    of the workspace [-1, 1]^3 is at a distance of 1.
    """
    winners = generator(seed, "visits").uniform(-1, 1, (samples, DIMENSIONS))
    rows = []
    for distance in distances:
        cell = np.zeros(DIMENSIONS)
        cell[0] = 1 - distance
        squares = ((winners - cell) ** 2).sum(axis=1)
        for width in widths:
            learned = np.exp(-squares / (2 * width**2))
            formula = expected_learning(width, DIMENSIONS, 2.0**DIMENSIONS)
            error = learned.std() / np.sqrt(samples)
            result = {"ratio": learned.mean() / formula, "error": error / formula}
            rows.append({"width": width, "distance": distance} | result)
    return pd.DataFrame(rows)
