"""What is damaged between two jobs is named and removed, whatever is wrong with it."""

import errno
import os
import tempfile
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from workflow.digests import Damaged, check, keep
from workflow.scripts.call import job


@pytest.fixture
def written(tmp_path):
    """A result with its digest."""
    path = tmp_path / "a.parquet"
    path.write_bytes(bytes(range(256)))
    keep([path])
    return path


def test_what_is_as_it_was_written_passes_and_what_is_made_anew_is_noted_anew(written):
    check([written])
    written.write_bytes(b"other")
    keep([written])
    check([written])


DAMAGE = {
    "a flipped bit": lambda data, at: data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :],
    "its end cut off": lambda data, at: data[:at],
    "longer": lambda data, at: data + b"\n",
}


@pytest.mark.parametrize("damage", DAMAGE)
@given(before=st.binary(min_size=1), place=st.floats(0, 1, exclude_max=True))
def test_what_is_damaged_is_named_and_removed_and_nothing_else(damage, before, place):
    after = DAMAGE[damage](before, int(place * len(before)))
    with tempfile.TemporaryDirectory() as folder:
        whole, damaged, unknown = (Path(folder, name) for name in ("a.csv", "b.npz", "c.rrd"))
        for path in (whole, damaged, unknown):
            path.write_bytes(before)
        keep([whole, damaged])
        for path in (damaged, unknown):
            path.write_bytes(after)
        with pytest.raises(Damaged, match=r"removed: \S*b\.npz; run again") as caught:
            check([whole, damaged, unknown])
        assert caught.value.paths == [damaged]
        assert not damaged.exists() and whole.exists() and unknown.exists()


def test_a_job_reads_nothing_damaged_and_notes_what_it_wrote(written, tmp_path):
    made = tmp_path / "made.csv"
    its = SimpleNamespace(rule="run", input=[str(written)], output=[str(made)])
    with job(its):
        made.write_text("1")
    check([made])
    written.write_bytes(b"")
    with pytest.raises(SystemExit, match=f"^run: damaged .*{written.name}; run again$"), job(its):
        pytest.fail("a job began with a damaged file")
    made.write_text("2")
    with pytest.raises(Damaged):
        check([made])


def test_a_full_disk_is_told_in_a_line(tmp_path):
    its = SimpleNamespace(rule="run", input=[], output=[str(tmp_path / "made.csv")])
    with pytest.raises(SystemExit, match="^run: .*No space left on device$"), job(its):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
