"""The meaning of the colours of a recording, which differ with deuteranopia, too.

With deuteranopia blue and yellow differ, and bright and dark; red and green do not.
"""

import numpy as np

WHITE, GREY = (255, 255, 255), (140, 150, 160)
BELIEVED = (86, 180, 233)  # what the controller believes, and by how much its commands are moved
WRONG = (240, 228, 66)  # where the arm is not what its controller believes
SHORT = (232, 218, 140)  # a link that is: paler, since it is large
MEASURED = (255, 150, 210)  # what an instrument says
LEARNERS = (86, 180, 233), (255, 130, 50), (0, 200, 160), (230, 130, 190)  # in the plots
DIM, LIT = np.array([95, 105, 125]), np.array([255, 255, 255])  # cells far from the winner, at it
NEAR, FAR = np.array([150, 255, 215]), np.array([255, 90, 30])  # bright and dark
NEAREST, FARTHEST = 1e-3, 0.1  # m: the misses that are drawn in these colours


def of_misses(misses: np.ndarray) -> np.ndarray:
    """Colours (n, 3) of misses (n,) in m, on a logarithmic scale."""
    share = np.log(np.clip(misses, NEAREST, FARTHEST) / NEAREST) / np.log(FARTHEST / NEAREST)
    return (NEAR + share[:, None] * (FAR - NEAR)).astype(np.uint8)
