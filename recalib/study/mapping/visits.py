"""The expected learning of a cell in one iteration (section 6): Monte Carlo beside the formula (10)."""

import numpy as np
import pandas as pd

from recalib.learners.schedules import expected_learning


def visits(
    widths, distances, dimensions: int, generator: np.random.Generator, samples: int = 1_000_000
) -> pd.DataFrame:
    """Simulated L over the one of (10), for cells at these distances from one face of the workspace.

    Args:
        widths: of the neighbourhood, in workspace coordinates.
        distances: of the cell to the nearest face, 1 being the centre of the workspace [-1, 1]^dimensions.
    """
    winners = generator.uniform(-1, 1, (samples, dimensions))
    rows = []
    for distance in distances:
        cell = np.zeros(dimensions)
        cell[0] = 1 - distance
        squares = ((winners - cell) ** 2).sum(axis=1)
        for width in widths:
            learned = np.exp(-squares / (2 * width**2))
            formula = expected_learning(width, dimensions, 2.0**dimensions)
            error = learned.std() / np.sqrt(samples)
            rows.append(
                {
                    "width": width,
                    "distance": distance,
                    "ratio": learned.mean() / formula,
                    "error": error / formula,
                }
            )
    return pd.DataFrame(rows)
