"""What the drawings of a page are made of."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from recalib.laboratory.drawings import _errors
from recalib.laboratory.panels import BOTTOM, LEFT, RIGHT, TOP, Axis, Panel, drawing

FIELD = 400, 200


def panel(*axes, **options) -> Panel:
    return Panel((FIELD[0] + LEFT + RIGHT, FIELD[1] + TOP + BOTTOM), axes, **options)


@pytest.mark.parametrize(
    ("numbers", "least", "ticks"),
    [
        ([0, 1], None, [0, 0.5, 1]),
        ([-3.1, 4.2], None, [-2, 0, 2, 4]),
        ([0.02, 30000], 1e-4, [0.1, 1, 10, 100, 1000, 10000]),
        ([0.3, 3], 1e-4, [0.5, 1, 2]),
        ([0, 0], 1e-4, [5e-5, 1e-4, 2e-4]),
    ],
)
def test_ticks_are_round_numbers_within_the_axis(numbers, least, ticks):
    assert Axis("", np.array(numbers), least).ticks() == pytest.approx(ticks)


def numbers(text: str) -> np.ndarray:
    return np.array(re.findall(r"[-.0-9]+", text), dtype=float)


def test_numbers_stand_where_their_axes_have_them():
    across, up = Axis("x [mm]", np.array([1, 1000]), 1e-4), Axis("y", np.array([0, 10]))
    across.ends, up.ends = (0, 3), (0, 10)
    its = panel(across, up)
    its.line(np.array([1.0, 10, 1000]), np.array([0.0, 5, 10]), "red", 2)
    points = numbers(re.search('points="(.*?)"', its.drawn[-1])[1])
    expected = [LEFT, TOP + 200, LEFT + 400 / 3, TOP + 100, LEFT + 400, TOP]
    assert points == pytest.approx(expected, abs=0.06)
    its.spikes(np.array([[1.0, 5.0]]), np.array([[1000.0, 5.0]]), "red")
    corners, height = numbers(re.search(' d="(.*?)"', its.drawn[-1])[1]), TOP + 100
    assert corners == pytest.approx([LEFT, height + 1.5, LEFT + 400, height, LEFT, height - 1.5])


def test_at_one_scale_a_square_is_a_square_in_the_middle():
    its = panel(*(Axis("", np.array([0.0, 2])) for _ in range(2)), alike=True)
    its.line(np.array([0.0, 2, 2]), np.array([0.0, 0, 2]), "red", 2)
    one, two, three = numbers(re.search('points="(.*?)"', its.drawn[-1])[1]).reshape(3, 2)
    assert two[0] - one[0] == pytest.approx(two[1] - three[1], abs=0.2) == pytest.approx(185, 0.01)
    assert (one + three) / 2 == pytest.approx([LEFT + 200, TOP + 100], abs=0.1)


def test_dots_that_nobody_can_tell_apart_are_one_and_names_are_text():
    its = panel(Axis("a <b>", np.array([0, 1])), Axis("", np.array([0, 1])))
    its.dots(np.tile([0.2, 0.8], 500), np.tile([0.3, 0.6], 500), "red", 4)
    assert its.drawn[-1].count("h0") == 2
    text = drawing([its] * 3, 2)
    assert "a &lt;b&gt;" in text and "<b>" not in text
    assert (
        text.count("<g ") == 3 and f'viewBox="0 0 {2 * its.size[0]:g} {2 * its.size[1]:g}"' in text
    )


def test_the_errors_that_are_drawn_are_lengths_of_positions_or_of_turns():
    result = SimpleNamespace(residuals={"before": np.array([[1.0, 2, 2, 2, 3, 6]])})
    assert _errors(result, 0, 1e3) == {"before": pytest.approx([3e3])}
    assert _errors(result, 1, 1.0) == {"before": pytest.approx([7.0])}
