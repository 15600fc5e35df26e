"""What a cluster must know of each job."""

import re

import pytest
import yaml

from tests.conftest import ROOT

RULE = re.compile(r"^( *)rule(?: (\w+))?:\n((?:\1    .*\n|\n)+)", re.MULTILINE)
ALIKE = re.compile(r"^use rule (\w+) as (\w+) with:$", re.MULTILINE)
TEXTS = [path.read_text(encoding="utf-8") for path in (ROOT / "workflow" / "rules").glob("*.smk")]
RULES = [(match[2], match[3]) for text in TEXTS for match in RULE.finditer(text)]
RULES += [(new, dict(RULES)[old]) for text in TEXTS for old, new in ALIKE.findall(text)]
WORKING = [rule for rule in RULES if re.search(r"^ *(script|shell):", rule[1], re.MULTILINE)]


@pytest.fixture(scope="module")
def profile():
    return yaml.safe_load((ROOT / "profiles" / "slurm" / "config.yaml").read_text(encoding="utf-8"))


def test_all_rules_are_seen():
    heads = [re.findall(r"^ *(?:use )?rule\b.*:$", text, re.MULTILINE) for text in TEXTS]
    assert len(RULES) == sum(map(len, heads)) > 30


@pytest.mark.parametrize(("name", "text"), WORKING, ids=[str(name) for name, _ in WORKING])
def test_a_rule_says_what_its_jobs_may_take_or_stays_at_home(name, text):
    at_home = "localrule: True" in text
    room = re.search(r"threads: \d+\n *resources:\n *\*\*room\(mem_mb=\d+, runtime=\d+\)", text)
    assert at_home != bool(room)


def test_what_travels_together_may_leave_home(profile):
    leaving = {name for name, text in WORKING if "localrule: True" not in text}
    assert {*profile["groups"]} <= leaving
    assert {*profile["groups"].values()} == {*profile["group-components"]}
