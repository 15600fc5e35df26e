"""Colours that mean different things differ, also to the colour-blind."""

import re
from itertools import combinations

import numpy as np
import pytest

from replication.recording import colours
from tests.conftest import ROOT

# of linear RGB, at full severity: Machado, Oliveira and Fernandes, 2009
VISION = {
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
LEAST = 15  # of CIELAB between two meanings: some six times what an eye can just tell apart
SITE = ROOT / "workflow" / "site" / "try" / "try.css"
PAPER = {"light": "#ffffff", "dark": "#1e2129"}  # of the site's theme


def linear(colour) -> np.ndarray:
    share = np.array(colour) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def lab(rgb) -> np.ndarray:
    """CIELAB of linear RGB (3,), relative to white."""
    share = XYZ @ np.clip(rgb, 0, 1) / XYZ.sum(axis=1)
    x, y, z = np.where(share > (6 / 29) ** 3, np.cbrt(share), share * 841 / 108 + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def apart(shades: dict[str, np.ndarray]) -> float:
    """The least distance between two of them."""
    return min(np.linalg.norm(one - other) for one, other in combinations(shades.values(), 2))


@pytest.mark.parametrize("vision", VISION)
def test_colours_that_mean_different_things_differ(vision):
    named = {name: colour for name, colour in vars(colours).items() if name.isupper()}
    assert len(named) == 6
    shades = {name: lab(VISION[vision] @ linear(colour)) for name, colour in named.items()}
    assert apart(shades) >= LEAST


@pytest.mark.parametrize("scheme", PAPER)
@pytest.mark.parametrize("vision", VISION)
def test_so_do_those_of_the_site_where_one_can_try_it(vision, scheme):
    found = re.findall(r"--(\w+): (#\w{6});", SITE.read_text(encoding="utf-8"))
    assert len(found) == 10, "five by day, five by night"
    half = found[:5] if scheme == "light" else found[5:]
    shades = {
        name: lab(VISION[vision] @ linear(list(bytes.fromhex(text[1:]))))
        for name, text in [*half, ("paper", PAPER[scheme])]
    }
    assert apart(shades) >= LEAST
