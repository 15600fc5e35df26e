"""A mistake in the configuration is reported in a sentence with its place, before work starts."""

import re

import pytest
import yaml

from recalib.damaged import Imperfection
from replication.config import MOST_SHOWN, InvalidConfiguration, Study, read_study, schema
from replication.running import check, check_robots, study_of
from tests.conftest import ROOT
from tests.conftest import changed as with_keys

SHIPPED = ROOT / "config.yaml"
# without lines of comments, which take time to read
TEXT = re.sub(r"(?m)^ *#.*\n", "", SHIPPED.read_text(encoding="utf-8"))
MISTAKES, OF_STUDIES = (
    yaml.safe_load((ROOT / "tests" / f"{name}.yaml").read_text(encoding="utf-8"))
    for name in ("mistakes", "mistakes_of_studies")
)
HOME = ["0 deg", "-45 deg", "0 deg", "-120 deg", "0 deg", "75 deg", "45 deg"]
PANDA = (
    "&panda {urdf: panda.urdf, tool: panda_link8, home: {"
    + ", ".join(f"panda_joint{number}: {angle}" for number, angle in enumerate(HOME, 1))
    + "}, workspace: {position: [20 cm, 24 cm, 20 cm], orientation: [40 deg, 40 deg, 40 deg]},"
    " links: [panda_link2, panda_link3, panda_link4, panda_link6]}"
)


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "workflow").symlink_to(ROOT / "workflow")  # with the URDF of a robot
    return tmp_path


def mistakes_of(here, text, *overlays) -> list[str]:
    (here / "config.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InvalidConfiguration) as caught:
        read_study("config.yaml", *overlays, checks=(check, check_robots))
    return caught.value.mistakes


def expected_messages(row) -> list[str]:
    """The messages about a row: a sentence, or one for each key."""
    return row["says"] if isinstance(row["says"], list) else [row["says"]]


def matches(sentence: str, expected: str) -> bool:
    """Of an expected sentence that ends with ..., the beginning."""
    start = expected.removesuffix("...")
    return sentence.startswith(start) if expected != start else sentence == expected


def position(text, offset) -> str:
    """Line and column, from 1, of a character."""
    before = text[:offset].split("\n")
    return f"{len(before)}:{len(before[-1]) + 1}"


@pytest.mark.parametrize("row", MISTAKES, ids=[row["now"] for row in MISTAKES])
def test_a_mistake_is_told_in_a_sentence_with_its_place(here, row):
    assert row["was"] in TEXT
    changed = TEXT.replace(row["was"], row["now"], 1)
    place = changed.find(row.get("at", "@"))
    changed = changed.replace("@", "", 1)
    where = position(changed, place) if place >= 0 else "1:1"
    first, *others = expected_messages(row)
    (mistake, *rest) = sorted(
        mistakes_of(here, changed), key=lambda line: not line.startswith(f"config.yaml:{where}:")
    )
    assert matches(mistake, f"config.yaml:{where}: {first}")
    assert [line.split(": ", 1)[1] for line in rest] == others


@pytest.mark.parametrize("row", OF_STUDIES, ids=[row["why"] for row in OF_STUDIES])
def test_a_mistake_in_a_study_of_ones_own_is_told_of_the_file_that_one_wrote(here, row):
    """By the function that the workflow calls before anything else."""
    name = row.get("file", "mine.yaml")
    (here / name).write_text(row["study"].replace("{panda}", PANDA), encoding="utf-8")
    with pytest.raises(InvalidConfiguration) as caught:
        study_of(ROOT, [here / name])
    lines = [line.partition(":") for line in caught.value.mistakes]
    assert {source for source, _, _ in lines} == {name}
    for (_, _, sentence), expected in zip(lines, expected_messages(row), strict=True):
        assert matches(sentence.strip(), expected)
    assert not any("config.yaml" in line for line in caught.value.mistakes)


def test_of_what_is_no_damage_the_keys_of_all_kinds_are_told(here):
    (mistake,) = mistakes_of(here, TEXT.replace("- assigned: links", "- links", 1))
    assert all(re.search(rf"\b{word}\b", mistake) for word in Imperfection.kinds)


def test_of_many_mistakes_the_first_are_shown(here):
    text = "".join(f"key{number}: 1\n" for number in range(MOST_SHOWN + 5))
    (here / "mine.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InvalidConfiguration) as caught:
        read_study(SHIPPED, "mine.yaml")
    assert str(caught.value).splitlines()[MOST_SHOWN:] == ["... and 5 more"]
    changed = TEXT.replace("greatest_condition: 60", "greatest_condition: 0", 1)
    changed = changed.replace("trials: 640", "trials: many", 1).replace("seed: 1996", "sede: 1", 1)
    keys = [line.split(": ")[1].split()[0] for line in mistakes_of(here, changed)]
    assert keys == ["sede", "controller.greatest_condition", "search.trials"]


def test_shipped_robots_can_do_what_is_asked_and_a_redundant_arm_is_asked_for_no_evidence(study):
    assert check_robots(study) == []
    study = read_study(SHIPPED, ROOT / "workflow" / "studies" / "panda.yaml")
    assert check_robots(study) == []
    (mistake,) = check_robots(with_keys(study, experiments={"evidence": True}))
    assert mistake.path == ("experiments", "evidence")
    assert "expected: false with the panda, an arm of 7 joints" in mistake.fault


def test_a_study_survives_the_round_trip_and_has_a_schema_that_describes_every_key():
    study = read_study(SHIPPED)
    assert Study.model_validate_json(study.model_dump_json()) == study
    assert (ROOT / schema.FILE).read_text(encoding="utf-8") == schema.text(), (
        "python -m replication.config.schema writes it anew"
    )
    whole = schema.json_schema()
    undescribed = [
        key
        for part in (whole, *whole["$defs"].values())
        for key, value in part["properties"].items()
        if not (value.get("description") or schema.resolved(value).get("description"))
    ]
    assert undescribed == []


def test_overlays_change_keys_and_replace_all_else(here):
    (here / "mine.yaml").write_text(
        "name: mine\nrobots: {ur3: {tool: ee_link}}\nlearners: {improved: {theta: values}}\n"
        "experiments: {scenarios: [intact], evidence: false}\n"
    )
    shipped = read_study(SHIPPED)
    mine = read_study(SHIPPED, "mine.yaml", {"seed": 3, "name": "yours"}, {"seed": 4})
    assert (mine.name, mine.seed) == ("yours", 4)
    assert mine.experiments.scenarios == ("intact",)
    assert mine.robots["ur3"].tool == "ee_link"
    assert mine.robots["ur3"].home == shipped.robots["ur3"].home
    assert mine.robots["ur5"] == shipped.robots["ur5"]
    assert mine.learners["improved"].theta == "values"
    assert mine.learners["improved"].maps == "separate"
    (here / "config.yaml").write_text(TEXT.replace("seed: 1996", "seed: many", 1))
    assert read_study("config.yaml", {"seed": 2}).seed == 2


def test_a_mistake_in_an_overlay_names_the_overlay(here):
    (here / "mine.yaml").write_text("name: mine\ntraining:\n  seeds: 1\n")
    with pytest.raises(InvalidConfiguration) as caught:
        read_study(SHIPPED, "mine.yaml", {"sede": 3, "training": {"tests": "many"}})
    assert caught.value.mistakes == [
        "mine.yaml:3:3: training.seeds is 1; expected: greater than or equal to 2",
        "the command line: training.tests is 'many'; expected: a valid integer",
        "the command line: sede: unknown key; did you mean seed?",
    ]
