"""YAML, read strictly: what values are, where they stand, and why a file is refused."""

from pathlib import Path

import pytest

from replication.config import InvalidConfiguration, from_file, from_mapping, shown

TEXT = """\
# a study
names: {one: 1, two: -2.5e3, three: yes, four: 0x10, five: 1:30, six: 2026-11-23}
list: [true, False, ~, null, .inf, -.inf, 1e5, +7, 1_000, "4", '', 4 cm]
base: &base {a: 1, b: [2, {c: 3}]}
other: &other {<<: *base, a: 9}
again: *base
merged: *other
empty:
zeros: [08, -010]
"""
BASE = {"a": 1, "b": [2, {"c": 3}]}
INF = float("inf")
NOTHING = "1:1: no configuration; expected: keys with their values"


@pytest.fixture
def whole(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("study.yaml").write_text(TEXT, encoding="utf-8")
    return from_file("study.yaml")


def test_words_are_those_of_yaml_1_2(whole):
    """Where 1.1 has true, sixteen, a minute and a half, a date, a thousand and octal numbers."""
    names = {"one": 1, "two": -2500.0, "three": "yes", "four": 16, "five": "1:30"}
    assert whole.plain() == {
        "names": names | {"six": "2026-11-23"},
        "list": [True, False, None, None, INF, -INF, 1e5, 7, 1000, "4", "", "4 cm"],
        "base": BASE,
        "other": BASE | {"a": 9},
        "again": BASE,
        "merged": BASE | {"a": 9},
        "empty": None,
        "zeros": [8, -10],
    }


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ((), "1:1"),
        (("names", "two"), "2:17"),
        (("list", 11), "3:68"),
        (("base", "b", 1, "c"), "4:28"),
        (("again", "b", 1, "c"), "4:28"),  # where the anchor has it
        (("other", "a"), "5:27"),
        (("other", "b"), "4:20"),
        (("list", 99), "3:1"),  # the last one on the way
    ],
)
def test_a_value_knows_line_and_column_of_its_key(whole, path, place):
    assert shown(whole.at(path).place) == f"study.yaml:{place}"


def test_what_is_laid_over_it_keeps_its_own_place(whole):
    laid = whole.under(from_mapping({"names": {"one": 5, "seven": (1, 2)}, "list": [3]}))
    assert laid.plain()["names"]["one"] == 5 and laid.plain()["names"]["seven"] == [1, 2]
    assert laid.plain()["names"]["two"] == -2500.0, "mappings are laid over key by key"
    assert laid.plain()["list"] == [3], "lists as a whole"
    places = [shown(laid.at(("names", name)).place) for name in ("one", "two")]
    assert places == ["the command line", "study.yaml:2:17"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a: 1\nb: {c: 1,\n  c: 2}\n", "3:3: invalid YAML: duplicate key c"),
        ("a:\n\tb: 1\n", "2:1: invalid YAML: found character .* that cannot start any token"),
        ("a: 1\n  b: 2\n", "2:4: invalid YAML: mapping values are not allowed here"),
        ("a: [1, 2\nb: 3\n", "2:2: invalid YAML: .* in the part from line 1"),
        ("a: !!python/name:os.getcwd x\n", "1:1: invalid YAML: unknown tag .*os.getcwd"),
        ("? [a]\n: 1\n", "1:3: invalid YAML: a key that is not text"),
        *((text, NOTHING) for text in ("seed\n", "", "# nothing\n", "{}\n", "---\n")),
        (None, " No such file or directory"),
        ("a: \udcff\n", " not a text in UTF-8"),
        ("a: \x07\n", " not a text in UTF-8"),
        pytest.param(
            "a: " + "[" * 9999, " an anchor within itself, or too many brackets", id="deep"
        ),
    ],
)
def test_what_is_no_configuration_is_refused_at_its_place(tmp_path, monkeypatch, text, says):
    monkeypatch.chdir(tmp_path)
    if text is not None:
        Path("wrong.yaml").write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(InvalidConfiguration, match=f"^wrong.yaml:{says}$"):
        from_file("wrong.yaml")
