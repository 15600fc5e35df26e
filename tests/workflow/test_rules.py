"""What rules hand over, what a cluster must know of them, and what Snakemake's own checks find."""

import re
import sys
from inspect import Parameter, signature
from pkgutil import resolve_name

import pytest
import yaml

from replication.config import Study
from tests.conftest import ROOT, run

TRACKED = {"function", "study", "code", "digits"}  # for Snakemake, or for the script


def test_every_rule_fits_its_function(rules, study):
    calling = [rule for rule in rules if "function" in rule.params.keys()]  # noqa: SIM118
    assert len(calling) > 15
    for rule in calling:
        function = resolve_name(rule.params.function)
        takes = signature(function).parameters
        needed = {name for name, parameter in takes.items() if parameter.default is Parameter.empty}
        params = {*rule.params.keys()}
        assert needed - {"study"} <= {*rule.input.keys(), *rule.output.keys(), *params}, rule
        assert params - TRACKED <= {*takes}, rule
        assert Study.model_validate_json(rule.params.study) == study


@pytest.fixture
def leaving(rules) -> dict:
    """By name, the rules with jobs that do not stay where Snakemake runs."""
    at_home = rules[0].workflow._localrules
    working = [rule for rule in rules if rule.script or rule.shellcmd]
    return {rule.name: rule for rule in working if rule.name not in at_home}


def test_a_rule_says_what_its_jobs_may_take_or_stays_at_home(leaving, rules):
    asking = {rule.name for rule in rules if "runtime" in rule.resources}
    assert {*leaving} == asking and len(asking) > 10
    assert all("mem_mb" in rule.resources for rule in leaving.values())


def test_what_travels_together_may_leave_home(leaving):
    path = ROOT / "profiles" / "slurm" / "config.yaml"
    profile = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert {*profile["groups"]} <= {*leaving}
    named = {rule._group for rule in leaving.values() if rule._group}  # `group`: on a cluster alone
    assert {*profile["groups"].values()} | named == {*profile["group-components"]}


MEANT = {
    "Specify a conda environment": "requirements.lock is the environment of all rules",
    "Mixed rules and functions": "what finds the inputs of one rule stands beside it",
}


def test_the_workflow_is_clean():
    linted = run(sys.executable, "-m", "snakemake", "--lint")
    titles = re.findall(r"^    \* (.*?):$", linted.stdout + linted.stderr, re.MULTILINE)
    assert titles
    assert [title for title in titles if not title.startswith(tuple(MEANT))] == []
