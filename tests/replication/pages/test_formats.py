"""Numbers as pages show them, and the reasons of choices."""

import pytest

from replication.judgement import Number
from replication.pages import formats, read_choices


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (0.6944, "0.694"), (12.5, "12.5"), (20000, "20,000"), (3e-12, "below 1e-6")],
)
def test_a_number_has_three_digits(value, text):
    assert formats.short(value) == text


def test_a_share_is_in_percent():
    assert formats.percent(0.0694) == "6.9 %"
    assert formats.interval((0.06, 0.079), formats.percent) == "6 to 7.9 %"
    assert formats.ratio(0.1) == "11 %"  # exp(0.1) is 1.105


@pytest.mark.parametrize(
    ("interval", "bound", "text"),
    [
        ((0.11, 0.14), None, "0.12 (0.11 to 0.14)"),
        (None, None, "0.12"),
        ((0.12, 0.12001), None, "0.12"),  # an interval that no page can show
        (None, "at least", "at least 0.12"),
    ],
)
def test_an_estimate_has_its_interval(interval, bound, text):
    number = Number(name="a", system="b", value=0.12, interval=interval, bound=bound)
    assert formats.estimate(number) == text


TEXT = """
# of all: no key stands directly below

one: 1  # behind it
# above it
# in two lines
two:
  # inner
  three: {a: [1, 2], b: c}  # and behind
  four: 4
  five:
    - x: 5 cm  # of an item
"""


def test_a_reason_stands_above_a_key_or_behind_its_value(tmp_path):
    path = tmp_path / "config.yaml"
    path.write_text(TEXT)
    found = {name: (choice.values[0], choice.reason) for name, choice in read_choices(path).items()}
    assert found["one"] == ("1", "behind it")
    assert found["two"][1] == "above it in two lines"
    assert found["two.three"] == ("{a: [1, 2], b: c}", "inner and behind")
    assert {*found} == {"one", "two", "two.three"}, "a key without a comment has no reason"
