"""What is damaged between two jobs is named and removed, whatever kind of file it is."""

import errno
import os
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from workflow.digests import Damaged, check, keep
from workflow.scripts.call import job

TABLE = pd.DataFrame({"error": np.linspace(0, 1, 100)})
WRITE = {
    "a.parquet": lambda path: TABLE.to_parquet(path, index=False),
    "a.csv": lambda path: TABLE.to_csv(path, index=False),
    "a.json": lambda path: path.write_text('{"number": 0.5}'),
    "a.npz": lambda path: np.savez(path, theta=np.zeros(100)),
    "a.rrd": lambda path: path.write_bytes(bytes(range(256))),
}


def flipped(data: bytes, place: float) -> bytes:
    """One bit of it is another."""
    index = int(place * len(data))
    return data[:index] + bytes([data[index] ^ 1]) + data[index + 1 :]


DAMAGE = {
    "the first byte": lambda data: flipped(data, 0),
    "a byte in the middle": lambda data: flipped(data, 0.5),
    "the last byte": lambda data: flipped(data, 1 - 1e-9),
    "truncated": lambda data: data[:-1],
    "empty": lambda data: b"",
    "longer": lambda data: data + b"\n",
}


@pytest.fixture(params=WRITE)
def written(request, tmp_path):
    """A result of each kind, with its digest."""
    path = tmp_path / request.param
    WRITE[request.param](path)
    keep([path])
    return path


def test_what_is_as_it_was_written_passes(written):
    check([written])
    keep([written])
    check([written])


@pytest.mark.parametrize("damage", DAMAGE)
def test_what_is_damaged_is_named_and_removed(written, damage, tmp_path):
    whole = tmp_path / "whole.csv"
    whole.write_text("error\n1\n")
    keep([whole])
    written.write_bytes(DAMAGE[damage](written.read_bytes()))
    with pytest.raises(Damaged, match=rf"removed: \S*{written.name}; run again") as caught:
        check([whole, written])
    assert caught.value.paths == [written]
    assert not written.exists() and whole.exists()


def test_what_is_made_anew_is_noted_anew(written):
    written.write_bytes(b"other")
    keep([written])
    check([written])


def test_what_nobody_noted_is_not_judged(tmp_path):
    path = tmp_path / "shipped.csv"
    path.write_text("error\n1\n")
    check([path])
    assert path.exists()


def test_a_job_reads_nothing_damaged_and_notes_what_it_wrote(written, tmp_path, capsys):
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
