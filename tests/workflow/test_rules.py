"""Every rule hands over what its function asks for."""

from inspect import Parameter, signature
from pkgutil import resolve_name

from replication.config import Study

TRACKED = {"function", "study", "code", "digits"}  # for Snakemake, or for the script


def test_every_rule_fits_its_function(rules, study):
    calling = [its for its in rules if "function" in its.params.keys()]  # noqa: SIM118
    assert len(calling) > 15
    for rule in calling:
        function = resolve_name(rule.params.function)
        takes = signature(function).parameters
        needed = {name for name, its in takes.items() if its.default is Parameter.empty}
        params = {*rule.params.keys()}
        assert needed - {"study"} <= {*rule.input.keys(), *rule.output.keys(), *params}, rule
        assert params - TRACKED <= {*takes}, rule
        assert Study.model_validate_json(rule.params.study) == study
