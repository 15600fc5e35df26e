"""Expected learning of a cell in one iteration (section 6): Monte Carlo against equation (10)."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from recalib.learners.schedules import DIMENSIONS, expected_learning
from recalib.numerics.randomness import generator

WIDTHS = (0.1, 0.15, 0.2, 0.3, 0.5, 1.0)  # of the neighbourhood, in workspace coordinates
DISTANCES = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0)  # to a face; 1 is the centre
SAMPLES = 1_000_000


def visits(
    seed: int,
    widths: Sequence[float] = WIDTHS,
    distances: Sequence[float] = DISTANCES,
    samples: int = SAMPLES,
) -> pd.DataFrame:
    """Simulated L over the one of (10), for cells at these distances from a face of the workspace.

    Widths are those of the neighbourhood, samples the winners drawn. At a distance of 1 is the
    centre of the workspace [-1, 1]^3.
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
