"""Every rule hands over what its function asks for, of the right types."""

from inspect import Parameter, signature

import pytest

from tests.rules import calling, function_of
from workflow.scripts import call


def test_every_rule_fits_its_function(rules):
    assert len(calling(rules)) > 15
    for rule in calling(rules):
        given = {*rule.input.keys(), *rule.output.keys(), *rule.params.keys()}
        takes = signature(function_of(rule)).parameters
        needed = {name for name, its in takes.items() if its.default is Parameter.empty}
        assert needed - {"evidence"} <= given | {"study"}, rule
        own = {*rule.params.keys()} - {"function", "study", "code", "digits", "robots"}
        assert own <= {*takes}, rule


def test_an_argument_of_another_type_is_refused(tmp_path):
    pytest.importorskip("pydantic")
