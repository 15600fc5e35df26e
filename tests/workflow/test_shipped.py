"""Which studies a call has, and which of them may write what is committed."""

import json
from pathlib import Path

import pytest

from recalib.errors import RecalibError
from replication import studies
from replication.config.messages import InvalidConfiguration
from replication.running.studies import LOCK, read_studies, ship


@pytest.fixture
def project(with_studies, monkeypatch):
    """Its robots are not asked."""
    monkeypatch.setattr(studies, "ask_robots", lambda study, scenarios: [])
    return with_studies


def test_the_shipped_study_is_that_of_the_lock_and_others_stand_beside_it(project):
    main, found = read_studies(project, [], {})
    assert main == "results"
    assert [*found] == [
        "results",
        *(f"results/studies/{n}" for n in ("bent", "coarse", "panda", "quick", "ur3")),
    ]


def test_a_changed_study_is_refused_under_the_shipped_name_and_says_what_changed(project):
    with pytest.raises(RecalibError, match="it differs in seed, robot, and the shipped one alone"):
        read_studies(project, [], {"robot": "ur3", "seed": 5})
    main, found = read_studies(project, [], {"robot": "ur3", "name": "mine"})
    assert main == "results/studies/mine" and found[main].robot == "ur3"
    assert found["results"].robot == "ur10", "the shipped one is still there"


def test_where_copies_of_data_lie_is_no_change(project):
    mine, others = str(project / "mine.csv"), str(project / "others.csv")
    for path in (mine, others):
        Path(path).touch()
    places = {"real": {"data": {"fit": {"file": mine}, "test": {"file": others}}}}
    main, found = read_studies(project, [], places)
    assert main == "results" and found[main].real.data.fit.file == mine


def test_another_study_can_be_shipped(project):
    config = project / "config.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace("\nseed: 1996", "\nseed: 5"), encoding="utf-8")
    with pytest.raises(RecalibError, match="not the shipped study"):
        read_studies(project, [], {})
    before = json.loads((project / LOCK).read_text(encoding="utf-8"))
    ship(project)
    assert read_studies(project, [], {})[1]["results"].seed == 5
    now = json.loads((project / LOCK).read_text(encoding="utf-8"))
    assert [key for key in now if now[key] != before[key]] == ["seed"]


def test_two_studies_of_one_name_are_refused(project):
    with pytest.raises(RecalibError, match="two studies are called 'ur3'"):
        read_studies(project, [], {"name": "ur3", "seed": 5})


def mine(project, text: str, name: str = "mine.yaml"):
    path = project / name
    path.write_text(text, encoding="utf-8")
    return read_studies(project, [path], {})


@pytest.mark.parametrize(
    ("text", "like", "name", "changes"),
    [
        ("like: quick\nrobot: ur5\n", "quick", "my_arm", {"robot": "ur5", "expected": None}),
        ("like: bent\nseed: 5\nname: other\n", "bent", "other", {"seed": 5}),  # itself like one
    ],
)
def test_a_study_that_is_like_another_one_says_what_it_changes(text, like, name, changes, project):
    main, found = mine(project, text, "my_arm.yaml")
    other = found[f"results/studies/{like}"]
    assert main == f"results/studies/{name}"
    assert found[main] == other.model_copy(update={"name": name, **changes})


@pytest.mark.parametrize("like", ["bend", "[bent]", "null", "mine"])
def test_a_study_that_is_like_none_there_is_is_refused_by_its_place(project, like):
    with pytest.raises(
        InvalidConfiguration, match=r"mine.yaml:2:1: like is .*; expected: (one of )?bent, co"
    ):
        mine(project, f"robot: ur5\nlike: {like}\n")


def test_studies_that_are_like_each_other_are_refused(project):
    others = project / "workflow" / "studies"
    (others / "one.yaml").write_text("like: two\n", encoding="utf-8")
    (others / "two.yaml").write_text("like: one\n", encoding="utf-8")
    with pytest.raises(InvalidConfiguration, match=r"two.yaml:1:1: like is 'one'; expected: "):
        read_studies(project, [], {})


def test_the_command_line_has_numbers_and_null_inside_of_brackets(project):
    changes = {"name": "mine", "training": {"tests": "10"}, "expected": "null"}
    _, found = read_studies(project, [], changes)
    mine = found["results/studies/mine"]
    assert mine.training.tests == 10 and mine.expected is None
    with pytest.raises(InvalidConfiguration, match="training.tests is 'many'"):
        read_studies(project, [], {"name": "mine", "training": {"tests": "many"}})
