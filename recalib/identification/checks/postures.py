"""Which rows share a posture, and which joints stood still, within the noise."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from recalib.identification.model.linearisation import LEVER

ALIKE = 3.0  # standard deviations of the noise: less moves no target noticeably


@dataclass(frozen=True)
class Postures:
    """The postures in which an arm was measured.

    Attributes:
        numbers: (n,) of the posture of each row, in the order in which they come first.
        still: (joints,) whether a joint never moved.
    """

    numbers: np.ndarray
    still: np.ndarray

    def __len__(self) -> int:
        return int(self.numbers.max()) + 1

    @property
    def first(self) -> np.ndarray:
        """The row (p,) in which each posture comes first."""
        return np.unique(self.numbers, return_index=True)[1]


def find_postures(joints: np.ndarray, slides: np.ndarray, noise: float) -> Postures:
    """The postures in joint coordinates (n, joints) [rad, m].

    Args:
        slides: (joints,) whether a joint slides.
        noise: m along an axis. What moves the tool by less than three times as much is the same
            posture, where a turn of one rad counts as `LEVER`. So is a joint's next full turn.
    """
    radius, moved = ALIKE * noise, np.ptp(joints, axis=0) * np.where(slides, 1.0, LEVER)
    turns = joints[:, ~slides]
    circles = LEVER * np.concatenate([np.cos(turns), np.sin(turns)], axis=1)
    places = np.concatenate([joints[:, slides], circles], axis=1)
    tree, numbers = KDTree(places), np.full(len(places), -1)
    for row, place in enumerate(places):
        if numbers[row] < 0:  # a posture is no chain: all its rows are near the first of them
            alike = np.array(tree.query_ball_point(place, radius))
            numbers[alike[numbers[alike] < 0]] = numbers.max() + 1
    return Postures(numbers, moved <= radius)
