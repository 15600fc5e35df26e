"""Every change of what is registered has an entry, and the entry says what git says."""

import subprocess
from datetime import UTC, datetime

import pytest

from replication.config import DEVIATIONS
from replication.judgement import REMOVED, Change, Deviations, digests
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def told() -> Deviations:
    return Deviations.read(ROOT)


def changes(told: Deviations) -> list[Change]:
    """All of them, in the order of time."""
    earlier = [change for its in reversed(told.withdrawn) for change in its.changes]
    return [*earlier, *told.deviations]


def test_what_is_registered_is_as_the_last_entry_names_it(told, study):
    changed = told.undeclared(digests(study, ROOT))
    assert not changed, (
        f"{', '.join(changed)}: not as {DEVIATIONS} names it last. Try: add an entry there, with"
        " what `python -m replication.judgement.deviations` prints below `digests`"
    )


def test_an_entry_replaces_what_was_registered(told):
    entry = told.deviations[0].model_copy(update={"digests": {"b": "2", "c": REMOVED}})
    registered = dict.fromkeys("abc", "1")
    its = told.model_copy(update={"registered": registered, "deviations": (entry,)})
    assert its.undeclared({"a": "1", "b": "2"}) == {}
    found = its.undeclared({"b": "1", "c": "1", "d": "1"})
    assert found == {"b": "1", "c": "1", "d": "1", "a": REMOVED}


def test_entries_are_in_the_order_of_time(told):
    times = [change.when for change in changes(told)]
    assert times == sorted(times)


def test_entries_have_the_times_of_their_commits(told):
    stated = {change.commit: change.when for change in changes(told)}
    command = ["git", "show", "--no-patch", "--format=%ct", *stated]
    ran = subprocess.run(command, cwd=ROOT, text=True, capture_output=True, check=False)
    if ran.returncode:
        pytest.skip("needs the project's history")
    at = [datetime.fromtimestamp(int(its), UTC) for its in ran.stdout.split()]
    assert [*stated.values()] == [f"{its:%Y-%m-%d %H:%M}" for its in at]
