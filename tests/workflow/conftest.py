"""The workflow in a copy of the project: a run of the small study, killed and then continued.

That a killed run goes on is tested, too, and takes no run of its own.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.conftest import copy_project

SNAKEMAKE = [sys.executable, "-m", "snakemake", "--cores", "2"]
SMALL = ["--configfile", "tests/tiny.yaml"]
TINY = "results/studies/tiny"  # where its results lie, by the name in tests/tiny.yaml
PATIENCE = 600  # seconds for the first training to end


def snakemake(project, *arguments, small=True) -> subprocess.CompletedProcess:
    """Run the workflow in a copy of the project: on the small study, or as it is shipped."""
    return subprocess.run(
        [*SNAKEMAKE, *(SMALL if small else []), *arguments],
        cwd=project,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )


class Killed(NamedTuple):
    """A copy of the project whose run was killed.

    Attributes:
        folder: of the copy.
        done: when each chunk was written of those trainings that were done by then [ns].
    """

    folder: Path
    done: dict[Path, int]


@pytest.fixture(scope="session")
def killed(tmp_path_factory, controller) -> Killed:
    """A run of the small study, killed with all its jobs as soon as one training is done.

    What a controller needs is compiled by now, so that the copy has it: no job compiles it again.
    """
    folder = copy_project(tmp_path_factory.mktemp("project"))
    run = subprocess.Popen(
        [*SNAKEMAKE, *SMALL],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    whole = f"{TINY}/runs/*/[!.]*.parquet"  # a dot begins the name of a file in the making
    deadline = time.monotonic() + PATIENCE
    while run.poll() is None and not list(folder.glob(whole)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert run.poll() is None, "the run ended before it could be interrupted"
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    gathered = [path.relative_to(folder / TINY / "runs") for path in folder.glob(whole)]
    chunks = [
        path
        for run in gathered
        for path in folder.glob(f"{TINY}/chunks/runs/{run.parent}/{run.stem}.*.parquet")
    ]
    return Killed(folder, {path: path.stat().st_mtime_ns for path in chunks})


@pytest.fixture(scope="session")
def continued(killed) -> Path:
    """The same copy of the project, its run started again, and ended."""
    finished = snakemake(killed.folder)
    assert finished.returncode == 0, finished.stdout
    return killed.folder
