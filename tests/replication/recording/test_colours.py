"""Colours that mean different things differ, also to the colour-blind."""

import re
from collections.abc import Iterable
from itertools import combinations

import pytest
from coloraide import Color

from replication.recording import colours
from tests.conftest import ROOT

VISION = None, "protan", "deutan", "tritan"  # all colours, and without those of one kind of cone
LEAST = 15  # of CIELAB between two meanings: some six times what an eye can just tell apart
SITE = ROOT / "workflow" / "site" / "try" / "try.css"
PAPER = {"light": "#ffffff", "dark": "#1e2129"}  # of the site's theme


def apart(shades: Iterable[str], vision: str | None) -> float:
    """The least distance between two of them, as eyes of this vision see them."""
    colors = [Color(shade) for shade in shades]
    seen = [color.filter(vision, method="machado") if vision else color for color in colors]
    return min(one.distance(other, space="lab-d65") for one, other in combinations(seen, 2))


@pytest.mark.parametrize("vision", VISION)
def test_colours_that_mean_different_things_differ(vision):
    named = [bytes(colour).hex() for name, colour in vars(colours).items() if name.isupper()]
    assert len(named) == 6
    assert apart([f"#{digits}" for digits in named], vision) >= LEAST


@pytest.mark.parametrize("scheme", PAPER)
@pytest.mark.parametrize("vision", VISION)
def test_so_do_those_of_the_site_where_one_can_try_it(vision, scheme):
    found = re.findall(r"--\w+: (#\w{6});", SITE.read_text(encoding="utf-8"))
    assert len(found) == 10, "five by day, five by night"
    half = found[:5] if scheme == "light" else found[5:]
    assert apart([*half, PAPER[scheme]], vision) >= LEAST
