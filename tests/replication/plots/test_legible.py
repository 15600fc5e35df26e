"""How legible figures are: on a phone, in the article, and to the colour-blind."""

import re
from functools import cache
from io import StringIO
from itertools import combinations
from unittest import mock

import matplotlib.pyplot as plt
import pytest
from matplotlib.text import Text

from replication.plots import BOTH, FAILS, HOLDS, SHORTER, STEPS, STYLES, UNKNOWN, Figure
from tests.replication.recording.test_colours import LEAST as LEAST_APART
from tests.replication.recording.test_colours import VISION, apart

PHONE, LEAST = 360, 9  # pixels: as wide as a phone; the height of letters
ARTICLE, SMALLEST = 15 / 2.54, 7  # inches wide; points
MEANT = {style.color for style in (*STYLES.values(), *BOTH, *STEPS.values())} | {HOLDS, FAILS}
MEANT |= {color for color, _ in (*SHORTER.values(), *UNKNOWN)}
EVERY = pytest.mark.parametrize("name", Figure)


@cache
def texts(figure) -> list[Text]:
    """Those that are drawn: of ticks beyond an axis there are labels, too."""
    found, own = {}, Text.draw

    def draws(text, renderer):
        found[id(text)] = text
        own(text, renderer)

    with mock.patch.object(Text, "draw", draws):
        figure.draw_without_rendering()
    return [text for text in found.values() if text.get_visible() and text.get_text().strip()]


@EVERY
def test_words_are_large_enough_and_stand_on_no_others(figures, name):
    figure = figures[name]
    small = min(text.get_fontsize() for text in texts(figure))
    assert small * PHONE / (72 * figure.get_figwidth()) >= LEAST
    assert small * ARTICLE / figure.get_figwidth() >= SMALLEST
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
    for (one, box), (other, other_box) in combinations(boxes, 2):
        assert not box.padded(-2).overlaps(other_box.padded(-2)), (one, other)
    for text, box in boxes:
        inside = box.x0 >= -1 and box.x1 <= figure.bbox.x1 + 1 and box.y0 >= -1
        assert inside and box.y1 <= figure.bbox.y1 + 1, text


def test_legends_hide_no_data(figures):
    for figure in figures.values():
        for axes in figure.axes:
            assert axes.get_legend() is None
            for legend in figure.legends:
                assert not legend.get_window_extent().overlaps(axes.get_window_extent())


@pytest.fixture(scope="module")
def colours(figures) -> dict[Figure, set[str]]:
    """Those that stand in each figure's drawing."""
    found = {}
    for name, figure in figures.items():
        drawing = StringIO()
        figure.set_layout_engine("none")  # all is where it will be
        with plt.rc_context({"svg.fonttype": "none"}):  # outlines of letters take seconds
            figure.savefig(drawing, format="svg")
        found[name] = {*re.findall(r"#[0-9a-f]{6}\b", drawing.getvalue())}
    return found


@pytest.mark.parametrize("vision", VISION)
def test_colours_of_a_figure_differ_to_everyone(colours, vision):
    """As much as those of recordings."""
    meant = {color.lower() for color in MEANT if color.startswith("#")}
    assert all(used & meant for used in colours.values())
    for name, used in colours.items():
        assert apart({*(used & meant), "#ffffff"}, vision) >= LEAST_APART, name
