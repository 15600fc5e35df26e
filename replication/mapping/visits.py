"""Expected learning of a cell in one iteration (section 6): equation (10) against Monte Carlo."""

import numpy as np
import pandas as pd

from recalib.learners.schedules import DIMENSIONS, expected_learning
from recalib.numerics.randomness import generator

WIDTHS = (0.1, 0.15, 0.2, 0.3, 0.5, 1.0)  # of the neighbourhood, in workspace coordinates
DISTANCES = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0)  # from a face; the centre is at 1
SAMPLES = 1_000_000  # random winners


def visits(seed: int) -> pd.DataFrame:
    """The ratio of simulated L to L in (10), for cells at `DISTANCES` from a face of [-1, 1]^3."""
    winners = generator(seed, "visits").uniform(-1, 1, (SAMPLES, DIMENSIONS))
    rows = []
    for distance in DISTANCES:
        cell = np.zeros(DIMENSIONS)
        cell[0] = 1 - distance
        squares = ((winners - cell) ** 2).sum(axis=1)
        for width in WIDTHS:
            learned = np.exp(-squares / (2 * width**2))
            formula = expected_learning(width, DIMENSIONS, 2.0**DIMENSIONS)
            error = learned.std() / np.sqrt(SAMPLES)
            result = {"ratio": learned.mean() / formula, "error": error / formula}
            rows.append({"width": width, "distance": distance} | result)
    return pd.DataFrame(rows)
