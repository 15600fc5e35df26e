"""One run at a time in a folder, and what ends one."""

import multiprocessing
import os
import shutil
import signal
import subprocess
import sys

import pytest

from recalib import RecalibError
from recalib.files import whole
from replication.running import MARK, NOTES, check_known, check_writable, hold
from tests.conftest import ROOT


def killed_while_writing(path):
    with whole(path) as temporary:
        temporary.write_text("half")
        os.kill(os.getpid(), signal.SIGKILL)


def held_elsewhere(folder, answers):
    try:
        answers.put(hold(folder))
    except RecalibError as error:
        answers.put(str(error))


@pytest.fixture(autouse=True)
def notes(tmp_path, monkeypatch):
    """The folder where Snakemake keeps its notes, in a project of the test's own."""
    monkeypatch.chdir(tmp_path)
    notes = (tmp_path / NOTES).parent
    notes.mkdir()
    return notes


@pytest.fixture
def results(tmp_path):
    """A folder of results with what killed processes left there, and in another study's."""
    folder = tmp_path / "results"
    for path in (folder / "runs/a.parquet", folder / "studies/b/runs/a.parquet"):
        spawned = multiprocessing.get_context("spawn").Process
        process = spawned(target=killed_while_writing, args=(path,))
        process.start()
        process.join()
    (folder / "runs/b.parquet").write_text("whole")
    return folder


def test_what_a_killed_run_left_is_swept_up_and_nothing_else(results):
    assert len(list(results.rglob(".*"))) == 2
    hold(str(results))
    remaining = {str(path.relative_to(results)) for path in results.rglob("*") if path.is_file()}
    (elsewhere,) = (results / "studies/b/runs").iterdir()
    assert remaining == {"runs/b.parquet", MARK, str(elsewhere.relative_to(results))}


def test_a_folder_is_held_until_the_process_ends(tmp_path):
    context = multiprocessing.get_context("spawn")
    answers = context.Queue()
    mine, ours = str(tmp_path / "mine"), str(tmp_path / "ours")
    hold(ours)
    busy = f"another run is at work in {ours}: wait until it has ended"
    for folder, expected in ((mine, None), (mine, None), (ours, busy)):
        process = context.Process(target=held_elsewhere, args=(folder, answers))
        process.start()
        process.join()
        assert answers.get(timeout=10) == expected


def test_results_without_notes_and_folders_that_are_read_only_are_refused(
    tmp_path, notes, monkeypatch
):
    check_known("results")
    hold("results")
    check_known("results")
    shutil.rmtree(notes)
    with pytest.raises(RecalibError, match="no records .*try: remove results or, if nothing"):
        check_known("results")
    notes.mkdir()
    hold("other")  # notes of other runs say as little
    with pytest.raises(RecalibError):
        check_known("results")
    (tmp_path / "results" / MARK).unlink()
    check_known("results")
    new = str(tmp_path / "new")
    check_writable(new)
    check_writable(str(tmp_path))
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write everywhere
    with pytest.raises(RecalibError, match=f"^nothing can be written in {tmp_path};"):
        check_writable(new)


def test_a_job_ends_at_once_and_without_a_word():
    process = subprocess.Popen(
        [sys.executable, "-c", "print('at work', flush=True); import time; time.sleep(600)"],
        env=os.environ | {"PYTHONPATH": str(ROOT / "workflow" / "start")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    assert process.communicate()[1] == b""
    assert process.returncode == -signal.SIGINT
