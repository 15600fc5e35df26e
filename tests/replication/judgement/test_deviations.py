"""What changed after a result had been seen has a line, and the line says what git says."""

import json
import re
import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from replication.config.shipped import DESIGN, DEVIATIONS
from replication.config.values import from_file
from replication.judgement.claims import CLAIMS
from replication.pages import deviations
from replication.pages.deviations import (
    NEEDS,
    REGISTERED,
    REMOVED,
    context,
    digests,
    unnamed,
)
from replication.pages.rendering import render
from tests.conftest import ROOT

FILE = ROOT / "workflow" / "deviations.yaml"
READ_AGAIN = "34056fe"  # the commit before the re-reading


@pytest.fixture(scope="module")
def told() -> dict:
    return from_file(FILE).plain()


def git(*arguments: str) -> str:
    ran = subprocess.run(["git", *arguments], cwd=ROOT, text=True, capture_output=True, check=False)
    if ran.returncode:
        pytest.skip(f"needs the project's history: git {' '.join(arguments)}")
    return ran.stdout.strip()


def test_each_criterion_choice_and_design_is_the_one_named_last(told):
    changed = unnamed(told, digests(ROOT))
    assert not changed, (
        f"{', '.join(changed)}: not as workflow/deviations.yaml names it last. Try: add an entry to"
        " `deviations` there that says what changed, why, what it did to the verdicts and which"
        " results had been seen; below its `digests`, put what"
        " `python -m replication.pages.deviations` prints."
    )


@pytest.fixture
def project(tmp_path) -> Path:
    """With all that digests are of."""
    for name in (*REGISTERED, "workflow/shipped.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    return tmp_path


def test_digests_are_of_criteria_of_choices_and_of_what_is_registered(project):
    shipped = {"search": "a" * 16, "benchmark": "b" * 16}
    (project / "workflow" / "shipped.json").write_text(json.dumps(shipped))
    before = digests(project)
    names = {claim.id for claim in CLAIMS} | {"config.yaml: search", *REGISTERED}
    assert set(before) == names and len(set(before.values())) == len(names)

    (project / DESIGN).write_text("drawn anew")
    (project / "workflow" / "shipped.json").write_text(json.dumps(shipped | {"search": "c"}))
    now = digests(project)
    changed = {name for name in now if now[name] != before[name]}
    assert changed == {"config.yaml: search", DESIGN}


@pytest.mark.parametrize("part", ["statement", "criterion", "limits"])
def test_a_claim_has_another_digest_if_any_part_of_its_criterion_changes(part, monkeypatch):
    first, *others = CLAIMS
    before = digests(ROOT)
    other = {"limits": {name: 2 * its for name, its in first.limits.items()}}.get(part, "other")
    monkeypatch.setattr(deviations, "CLAIMS", (replace(first, **{part: other}), *others))
    now = digests(ROOT)
    assert [name for name in now if now[name] != before[name]] == [first.id]


def test_what_an_entry_names_replaces_what_was_registered():
    entry = {"digests": {"b": "2", "c": REMOVED}}
    its = {"registered": {"a": "1", "b": "1", "c": "1"}, "deviations": [entry, {}]}
    assert unnamed(its, {"a": "1", "b": "2"}) == {}
    found = unnamed(its, {"b": "1", "c": "1", "d": "1"})
    assert found == {"b": "1", "c": "1", "d": "1", "a": REMOVED}


def test_the_command_prints_what_an_entry_has_to_name(project):
    told = "registered: {gone: it}\ndeviations: []\nreread: []\n"
    (project / DEVIATIONS).write_text(told)
    ran = subprocess.run(
        [sys.executable, "-m", "replication.pages.deviations"],
        cwd=project,
        env={"PYTHONPATH": str(ROOT)},
        text=True,
        capture_output=True,
        check=True,
    )
    expected = digests(ROOT) | {"gone": REMOVED}
    assert ran.stdout.splitlines() == [f'"{name}": "{its}"' for name, its in expected.items()]


def test_entries_are_in_the_order_of_time_and_only_the_last_is_without_a_commit(told):
    days = [each["when"] for each in told["deviations"]]
    assert days == sorted(days)
    assert all("commit" in each for each in told["deviations"] if ":" in each["when"])


def test_commits_are_of_the_time_that_is_told(told):
    days = [(each["commit"], each["when"]) for each in told["deviations"] if "commit" in each]
    commits = [*dict(days)]
    seconds = map(int, git("show", "--no-patch", "--format=%ct", *commits).splitlines())
    at = [f"{datetime.fromtimestamp(each, UTC):%Y-%m-%d %H:%M}" for each in seconds]
    assert set(days) == {*zip(commits, at, strict=True)}


def test_verdicts_before_the_re_reading_are_those_of_its_commit(told):
    page = git("show", f"{READ_AGAIN}:docs/results.md").split("## Claims\n")[1].split("\n## ")[0]
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")][2:]
    before = {k: its for each in told["reread"] for k, its in each.get("before", {}).items()}
    assert [cells[2].replace("**", "") for cells in rows] == [*before.values()]
    assert set(before) <= set(told["registered"])


def test_every_claim_of_today_stands_for_a_claim_before_or_is_new(told):
    now = [name for each in told["reread"] for name in each["now"]]
    assert sorted(now) == sorted(claim.id for claim in CLAIMS), "in `reread` of deviations.yaml"


def test_the_page_has_each_change_and_each_verdict_before_and_now(synthetic, told):
    said = context(synthetic.evidence(NEEDS))
    page = render(ROOT / "workflow" / "templates" / "deviations.md.j2", said)
    assert re.findall(r"^## (.+)$", page, re.MULTILINE)[:-1] == [
        each["what"] for each in told["deviations"]
    ]
    for each in told["deviations"]:
        told_here = page.split(f"\n## {each['what']}\n", 1)[1].split("\n## ")[0]
        assert all(each[key] in told_here for key in ("before", "after", "why", "verdict", "seen"))
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| separate-maps")]
    before = "not supported (not supported for the improved system, undecided for Ritter's)"
    judged = "**supported** (Ritter's, 1,000 iterations)"
    assert [cells[1:4] for cells in rows] == [[before, "separate-maps", judged]]
