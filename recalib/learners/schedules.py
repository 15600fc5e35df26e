"""How widths and learning rates fall during training: pure functions of the fraction of it that is done.

Every function takes the value at the start, the value at the end and the fraction in [0, 1]; they broadcast.
"""

import numpy as np

DIMENSIONS = (
    3  # of the space of each net's centres: positions for a supernet, orientations for a subnet
)


def exponential(start, end, fraction):
    """The same factor in every iteration: Ritter's decay of widths and rates, start (end / start)^fraction."""
    return start * (end / start) ** fraction


def linear(start, end, fraction):
    """The same step in every iteration: the improved system's slow decrease of the rate (section 7)."""
    return start + (end - start) * fraction


def equal_visits(start, end, fraction):
    """The same mean number of visits of a cell at every width (section 6).

    The time spent at a width is inversely proportional to the expected learning L of (10), which grows as the width to the
    power n of the dimensions: dt is proportional to width^-n d(width). Integrated, width^(1-n) grows linearly in time.
    """
    power = 1 - DIMENSIONS
    return linear(np.power(start, power), np.power(end, power), fraction) ** (1 / power)


def expected_learning(width, dimensions: int, volume: float):
    """L of (10): what a cell far from the border learns on average in one iteration with Gaussians of this width."""
    return np.power(width, dimensions) * (2 * np.pi) ** (dimensions / 2) / volume
