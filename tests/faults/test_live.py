"""A calibration that moves an arm is killed, and goes on."""

import os
import random
import signal
import subprocess
import sys
import time

from recalib.laboratory.command_line import DONE
from tests.conftest import ROOT
from tests.station.test_live import LINE


def test_killed_at_any_moment_it_goes_on_as_if_it_had_not_been(tmp_path):
    once, killed = tmp_path / "once", tmp_path / "killed"
    with start_live(once) as process:
        process.communicate()
    rng, before, lost = random.Random(8), [], 0
    for _ in range(5):
        with start_live(killed) as process:
            while "row" not in process.stderr.readline():  # it is about to make its first move
                pass
            time.sleep(rng.uniform(0, 0.3))
            process.kill()
            process.communicate()
        assert process.returncode == -signal.SIGKILL
        assert written(killed)[: len(before)] == before
        before = written(killed)
        # what was measured and not yet on the disk is lost with the process: one row, and no more
        assert unwritten(killed) - lost in (0, 1)
        lost = unwritten(killed)
    with start_live(killed) as process:
        process.communicate()
    assert process.returncode == DONE
    assert written(killed) == written(once) and len({*written(once)}) == len(written(once))
    measured = (killed / "measured").read_text().splitlines()
    assert unwritten(killed) == lost and len({*measured}) == len(written(once)) - 1


def start_live(folder):
    """`recalib live` in a folder, in a process of its own."""
    folder.mkdir(exist_ok=True)
    line = LINE.format("tests.faults.lasting:Lasting").replace("14", "40")  # it ends before that
    return subprocess.Popen(
        [sys.executable, "-m", "recalib", *line.split(), "--yes"],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def written(folder) -> list[str]:
    table = folder / "measurements.csv"
    return table.read_text().splitlines() if table.exists() else []


def unwritten(folder) -> int:
    """How many measurements are not in the table."""
    log = folder / "measured"
    measured = len(log.read_text().splitlines()) if log.exists() else 0
    return measured - len(written(folder)[1:])
