"""Ctrl-C in a terminal meets every job, whatever it does."""

import os
import signal
import subprocess
import sys

from tests.conftest import ROOT

WORKING = "print('at work', flush=True); import time; time.sleep(600)"


def test_a_job_ends_at_once_and_without_a_word():
    its = subprocess.Popen(
        [sys.executable, "-c", WORKING],
        env=os.environ | {"PYTHONPATH": str(ROOT / "workflow" / "start")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    its.stdout.readline()
    its.send_signal(signal.SIGINT)
    assert its.communicate()[1] == b""
    assert its.returncode == -signal.SIGINT
