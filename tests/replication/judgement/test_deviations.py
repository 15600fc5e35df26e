"""Every change of what is registered has an entry, and the entry says what git says."""

from datetime import UTC, datetime

import pytest

from replication.config import DEVIATIONS
from replication.judgement import REMOVED, Change, Deviations, digests
from tests.conftest import ROOT, run


@pytest.fixture(scope="module")
def record() -> Deviations:
    return Deviations.read(ROOT)


def changes(record: Deviations) -> list[Change]:
    """All of them, in the order of time."""
    earlier = [change for campaign in reversed(record.withdrawn) for change in campaign.changes]
    return [*earlier, *record.deviations]


def test_what_is_registered_is_as_the_last_entry_names_it(record, study):
    changed = record.undeclared(digests(study, ROOT))
    assert not changed, (
        f"{', '.join(changed)}: not as {DEVIATIONS} names it last. Try: add an entry there, with"
        " what `python -m replication.judgement.deviations` prints below `digests`"
    )


def test_an_entry_replaces_what_was_registered(record):
    entry = record.deviations[0].model_copy(update={"digests": {"b": "2", "c": REMOVED}})
    registered = dict.fromkeys("abc", "1")
    amended = record.model_copy(update={"registered": registered, "deviations": (entry,)})
    assert amended.undeclared({"a": "1", "b": "2"}) == {}
    found = amended.undeclared({"b": "1", "c": "1", "d": "1"})
    assert found == {"b": "1", "c": "1", "d": "1", "a": REMOVED}


def test_entries_are_in_the_order_of_time(record):
    times = [change.when for change in changes(record)]
    assert times == sorted(times)


def test_entries_have_the_times_of_their_commits(record):
    stated = {change.commit: change.when for change in changes(record)}
    process = run("git", "show", "--no-patch", "--format=%ct", *stated)
    if process.returncode:
        pytest.skip("needs the project's history")
    times = [datetime.fromtimestamp(int(time), UTC) for time in process.stdout.split()]
    assert [*stated.values()] == [f"{time:%Y-%m-%d %H:%M}" for time in times]
