"""How widths and learning rates fall during training.

Each function takes the value at the start, the value at the end and the fraction of the training
that is done, in [0, 1]; they broadcast.
"""

import numpy as np

DIMENSIONS = 3  # of each net's centres: positions for a supernet, orientations for a subnet


def exponential(start, end, fraction):
    """The same factor in every iteration: Ritter's decay of widths and rates."""
    return start * (end / start) ** fraction


def linear(start, end, fraction):
    """The same step in every iteration: how the improved system's rate falls (section 7)."""
    return start + (end - start) * fraction


def equal_visits(start, end, fraction):
    """The same mean number of visits of a cell at every width (section 6).

    The time spent at a width is inversely proportional to the expected learning L of (10), which
    grows as the width to the power n of the dimensions: dt is proportional to width^-n d(width).
    Integrated, width^(1-n) grows linearly in time.
    """
    power = 1 - DIMENSIONS
    return linear(np.power(start, power), np.power(end, power), fraction) ** (1 / power)


def expected_learning(width, dimensions: int, volume: float):
    """L of (10): what a cell far from the border learns in one iteration, on average.

    Args:
        width: of the Gaussians.
        dimensions: of the space in which the winners lie.
        volume: of the workspace there.
    """
    return np.power(width, dimensions) * (2 * np.pi) ** (dimensions / 2) / volume
