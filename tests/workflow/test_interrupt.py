"""Ctrl-C in a terminal meets every job, whatever it does."""

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import pytest
from workflow.scripts.job import job

from tests.conftest import ROOT

IMPORTING = "print('importing', flush=True); import time; time.sleep(600)"


def test_a_job_that_still_imports_ends_without_a_word():
    its = subprocess.Popen(
        [sys.executable, "-c", IMPORTING],
        env=os.environ | {"PYTHONPATH": str(ROOT / "workflow" / "start")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    its.stdout.readline()
    its.send_signal(signal.SIGINT)
    assert its.communicate()[1] == b""
    assert its.returncode == -signal.SIGINT


def test_a_job_at_work_ends_in_order(tmp_path):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        its = SimpleNamespace(rule="run", input=[], output=[str(tmp_path / "made.csv")])
        with pytest.raises(SystemExit, match="^run: interrupted$"), job(its):
            signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
