"""Every rule hands over what its function asks for, and nothing that it does not know."""

import json
from inspect import Parameter, signature

import pytest

from tests.rules import function_of
from workflow.scripts.call import checked

WILDCARDS = {
    "chunk": "0",
    "figure": "figure1",
    "learner": "improved",
    "number": "0",
    "page": "README.md",
    "part": "fit",
    "piece": "0",
    "recording": "links_encoders",
    "robot": "ur10",
    "scenario": "links",
    "series": "assignments",
    "table": "outcomes",
    "training": "improved_200",
}


def calling(rules) -> list:
    return [rule for rule in rules.workflow.rules if "function" in rule.params.keys()]  # noqa: SIM118


def test_every_rule_fits_its_function(rules, study):
    assert len(calling(rules)) > 30
    for rule in calling(rules):
        given = json.loads(rules.text(study, rule.name, **WILDCARDS))
        files = {*rule.input.keys(), *rule.output.keys()}
        takes = signature(function_of(rule)).parameters
        needed = {name for name, its in takes.items() if its.default is Parameter.empty}
        assert not files & {*given}, rule
        assert needed <= files | {*given} and {*given} <= {*takes}, rule
        rules.arguments(study, rule.name, **WILDCARDS)  # of the right types


def test_an_argument_of_another_type_or_name_is_refused():
    def function(number: int, names: tuple[str, ...] = ()):
        return number

    assert checked(function, {"number": 1, "names": ["a"]}) == {"number": 1, "names": ("a",)}
    for wrong in ({"number": "one"}, {"number": 1, "others": []}, {}):
        with pytest.raises(ValueError, match="validation error"):
            checked(function, wrong)
