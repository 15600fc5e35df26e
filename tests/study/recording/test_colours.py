"""Colours that mean different things differ, also to the colour-blind."""

from itertools import combinations

import numpy as np
import pytest

from recalib.study.recording import colours

# of linear RGB, at full severity: Machado, Oliveira and Fernandes, 2009
SEEN = {
    "all colours": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
XYZ = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)  # of linear RGB
FEWEST = 18  # between two meanings, in CIELAB: white and black are 100 apart


def linear(colour) -> np.ndarray:
    share = np.array(colour) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def lab(rgb) -> np.ndarray:
    """CIELAB of linear RGB (3,), relative to white."""
    share = XYZ @ np.clip(rgb, 0, 1) / XYZ.sum(axis=1)
    x, y, z = np.where(share > (6 / 29) ** 3, np.cbrt(share), share * 841 / 108 + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("seen", SEEN)
def test_colours_that_mean_different_things_differ(seen):
    of_learners = {f"LEARNERS[{n}]": colour for n, colour in enumerate(colours.LEARNERS)}
    assert of_learners.pop("LEARNERS[0]") == colours.BELIEVED
    named = {name: its for name, its in vars(colours).items() if name.isupper()} | of_learners
    del named["LEARNERS"]
    assert len(named) == 9
    shades = {name: lab(SEEN[seen] @ linear(colour)) for name, colour in named.items()}
    for one, other in combinations(shades, 2):
        assert np.linalg.norm(shades[one] - shades[other]) >= FEWEST, (one, other)
