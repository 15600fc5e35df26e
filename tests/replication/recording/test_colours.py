"""Colours that mean different things differ, also to the colour-blind."""

import re
from itertools import combinations

import numpy as np
import pytest

from replication.recording import colours
from tests.conftest import ROOT

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
FEWEST = 15  # of CIEDE2000 between two meanings
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


def ciede2000(one, other) -> float:
    """The distance of two colours in CIELAB: Sharma, Wu and Dalal, 2005."""
    (light1, a1, b1), (light2, a2, b2) = one, other
    mean = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    stretch = 1.5 - np.sqrt(mean**7 / (mean**7 + 25**7)) / 2
    chroma1, chroma2 = np.hypot(stretch * a1, b1), np.hypot(stretch * a2, b2)
    hue1 = np.degrees(np.arctan2(b1, stretch * a1)) % 360
    hue2 = np.degrees(np.arctan2(b2, stretch * a2)) % 360
    turn = (hue2 - hue1 + 180) % 360 - 180 if chroma1 * chroma2 else 0
    light, chroma = (light1 + light2) / 2, (chroma1 + chroma2) / 2
    hue = hue1 + turn / 2 if chroma1 * chroma2 else hue1 + hue2
    waves = ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.2, 4, -63))
    weight = 1 + sum(part * np.cos(np.radians(n * hue + turn)) for part, n, turn in waves)
    off = (light - 50) ** 2
    lights = (light2 - light1) / (1 + 0.015 * off / np.sqrt(20 + off))
    chromas = (chroma2 - chroma1) / (1 + 0.045 * chroma)
    hues = 2 * np.sqrt(chroma1 * chroma2) * np.sin(np.radians(turn / 2))
    hues /= 1 + 0.015 * chroma * weight
    bend = 60 * np.exp(-((((hue - 275 + 180) % 360 - 180) / 25) ** 2))
    rotation = -2 * np.sqrt(chroma**7 / (chroma**7 + 25**7)) * np.sin(np.radians(bend))
    return np.sqrt(lights**2 + chromas**2 + hues**2 + rotation * chromas * hues)


@pytest.mark.parametrize(
    ("one", "other", "distance"),
    [
        ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
        ((50, 0, 0), (50, -1, 2), 2.3669),
        ((50, 2.49, -0.001), (50, -2.49, 0.0011), 7.2195),
        ((50, 2.5, 0), (61, -5, 29), 22.8977),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((22.7233, 20.0904, -46.694), (23.0331, 14.973, -42.5619), 2.0373),
        ((2.0776, 0.0795, -1.135), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_distances_are_the_published_ones(one, other, distance):
    assert ciede2000(one, other) == pytest.approx(distance, abs=1e-4)
    assert ciede2000(other, one) == pytest.approx(distance, abs=1e-4)


@pytest.mark.parametrize("seen", SEEN)
def test_colours_that_mean_different_things_differ(seen):
    of_learners = {f"LEARNERS[{n}]": colour for n, colour in enumerate(colours.LEARNERS)}
    assert of_learners.pop("LEARNERS[0]") == colours.NOMINAL
    named = {name: its for name, its in vars(colours).items() if name.isupper()} | of_learners
    del named["LEARNERS"]
    assert len(named) == 9
    shades = {name: lab(SEEN[seen] @ linear(colour)) for name, colour in named.items()}
    for one, other in combinations(shades, 2):
        assert ciede2000(shades[one], shades[other]) >= FEWEST, (one, other)


@pytest.mark.parametrize("scheme", PAPER)
@pytest.mark.parametrize("seen", SEEN)
def test_so_do_those_of_the_site_where_one_can_try_it(seen, scheme):
    found = re.findall(r"--(\w+): (#\w{6});", SITE.read_text(encoding="utf-8"))
    assert len(found) == 10, "five by day, five by night"
    half = found[:5] if scheme == "light" else found[5:]
    shades = {
        name: lab(SEEN[seen] @ linear(list(bytes.fromhex(text[1:]))))
        for name, text in [*half, ("paper", PAPER[scheme])]
    }
    for one, other in combinations(shades, 2):
        assert ciede2000(shades[one], shades[other]) >= FEWEST, (one, other)
