"""Comments of a configuration are the reasons of its keys."""

from replication.pages import read_choices

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
    found = {name: (its.values[0], its.reason) for name, its in read_choices(path).items()}
    assert found["one"] == ("1", "behind it")
    assert found["two"][1] == "above it in two lines"
    assert found["two.three"] == ("{a: [1, 2], b: c}", "inner and behind")
    assert {*found} == {"one", "two", "two.three"}, "a key without a comment has no reason"
