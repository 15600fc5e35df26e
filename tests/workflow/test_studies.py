"""Which study a call has, and that the shipped one alone writes what is committed."""

import json

import pytest

from recalib import RecalibError
from replication.config import InvalidConfiguration
from replication.running import LOCK, ship, study_of


def of_call(project, *files, asking=False, **changes):
    return study_of(project, files, changes, asking=asking)


def test_a_changed_study_is_refused_under_the_shipped_name(with_studies):
    with pytest.raises(RecalibError, match="it differs in seed, robot, and only the shipped study"):
        of_call(with_studies, robot="ur3", seed=5)
    mine = of_call(with_studies, robot="ur3", name="mine")
    assert (mine.name, mine.robot) == ("mine", "ur3")
    assert of_call(with_studies).name == "replication"


def test_another_study_can_be_shipped(with_studies):
    config = with_studies / "config.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace("\nseed: 1996", "\nseed: 5"), encoding="utf-8")
    with pytest.raises(RecalibError, match="not the shipped study"):
        of_call(with_studies)
    before = json.loads((with_studies / LOCK).read_text(encoding="utf-8"))
    ship(with_studies)
    assert of_call(with_studies).seed == 5
    now = json.loads((with_studies / LOCK).read_text(encoding="utf-8"))
    assert [key for key in now if now[key] != before[key]] == ["seed"]


@pytest.mark.parametrize(
    ("text", "like", "name", "changes"),
    [
        ("like: quick\nrobot: ur5\n", "quick", "my_arm", {"robot": "ur5", "expected": None}),
        ("like: bent\nseed: 5\nname: other\n", "bent", "other", {"seed": 5}),  # itself like one
    ],
)
def test_a_study_that_is_like_another_one_says_what_it_changes(
    text, like, name, changes, with_studies
):
    path = with_studies / "my_arm.yaml"
    path.write_text(text, encoding="utf-8")
    mine, other = (
        of_call(with_studies, file)
        for file in (path, with_studies / "workflow" / "studies" / f"{like}.yaml")
    )
    assert mine == other.model_copy(update={"name": name, **changes})


@pytest.mark.parametrize("like", ["bend", "[bent]", "null", "mine"])
def test_a_study_that_is_like_none_there_is_is_refused_by_its_place(with_studies, like):
    path = with_studies / "mine.yaml"
    path.write_text(f"robot: ur5\nlike: {like}\n", encoding="utf-8")
    message = r"mine.yaml:2:1: like is .*; expected: (one of )?bent, co"
    with pytest.raises(InvalidConfiguration, match=message):
        of_call(with_studies, path)


def test_studies_that_are_like_each_other_are_refused(with_studies):
    others = with_studies / "workflow" / "studies"
    (others / "one.yaml").write_text("like: two\n", encoding="utf-8")
    (others / "two.yaml").write_text("like: one\n", encoding="utf-8")
    with pytest.raises(InvalidConfiguration, match=r"two.yaml:1:1: like is 'one'; expected: "):
        of_call(with_studies, others / "one.yaml")


def test_the_command_line_has_numbers_and_null_inside_of_brackets(with_studies):
    mine = of_call(with_studies, name="mine", training={"tests": "10"}, expected="null")
    assert mine.training.tests == 10 and mine.expected is None
    with pytest.raises(InvalidConfiguration, match="training.tests is 'many'"):
        of_call(with_studies, name="mine", training={"tests": "many"})


def test_a_robot_that_cannot_do_a_scenario_is_refused_before_anything_runs(with_studies):
    short = {"name": "mine", "paper_damage": {"shorten": ["1 m"]}}
    of_call(with_studies, **short)
    with pytest.raises(InvalidConfiguration, match="paper_damage.shorten"):
        of_call(with_studies, asking=True, **short)
