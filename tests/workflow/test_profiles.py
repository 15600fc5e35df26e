"""What a cluster must know of each job."""

import pytest
import yaml

from tests.conftest import ROOT


@pytest.fixture
def leaving(rules) -> dict:
    """By name, the rules with jobs that do not stay where Snakemake runs."""
    at_home = rules[0].workflow._localrules
    working = [its for its in rules if its.script or its.shellcmd]
    return {its.name: its for its in working if its.name not in at_home}


def test_a_rule_says_what_its_jobs_may_take_or_stays_at_home(leaving, rules):
    asking = {its.name for its in rules if "runtime" in its.resources}
    assert {*leaving} == asking and len(asking) > 10
    assert all("mem_mb" in its.resources for its in leaving.values())


def test_what_travels_together_may_leave_home(leaving):
    path = ROOT / "profiles" / "slurm" / "config.yaml"
    profile = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert {*profile["groups"]} <= {*leaving}
    named = {its._group for its in leaving.values() if its._group}  # `group`: on a cluster alone
    assert {*profile["groups"].values()} | named == {*profile["group-components"]}
