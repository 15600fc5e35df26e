"""A small campaign on a Slurm of one node gives the same bytes as here, whatever befalls it."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

import psutil
import pytest

from recalib.study.shipped import DESIGN
from tests.conftest import copy_project
from tests.slurm.cluster import Cluster, missing, wait_until

pytestmark = [
    pytest.mark.skipif(
        bool(missing()),
        reason=f"not installed: {', '.join(missing())} (on Debian in slurm-wlm and munge)",
    ),
    pytest.mark.skipif(
        not find_spec("snakemake_executor_plugin_slurm"),
        reason="Snakemake cannot talk to Slurm: `make cluster` installs what it needs",
    ),
]

UNIVERSES, TOGETHER, JOBS = 3, 2, 2  # universes of the campaign, those of a job, jobs in Slurm
CAMPAIGN = ["--configfile", "tests/slurm/campaign.yaml"]
# nobody minds to be asked often
HERE = ["--slurm-init-seconds-before-status-checks", "1"]
HERE += ["--group-components", f"universes={TOGETHER}"]


class Run:
    """A campaign of this name on its way, in a group of processes of its own."""

    def __init__(self, project: Path, name: str, arguments: list[str], environment: Mapping):
        self._project, self._name = project, name
        named = ["--config", f"name={name}", "--", "universes"]
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "snakemake", *arguments, *CAMPAIGN, *named],
                cwd=project,
                env=environment,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def _log(self) -> Path:
        return self._project / f"{self._name}.log"

    def said(self) -> str:
        """All that runs of this name have said."""
        return self._log.read_text(encoding="utf-8")

    def at_work(self) -> psutil.Process:
        """Wait until something is computed, and say where."""
        found = []

        def computing():
            assert self._process.poll() is None, self.said()
            found[:] = scripts(self._project)
            return found

        wait_until("a universe is being measured", computing)
        return found[0]

    def kill(self):
        """End Snakemake at once, if it still runs, and leave its jobs in Slurm alone."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()

    def made(self) -> dict[str, bytes]:
        """Wait for its end; by their paths, what the files hold that it made."""
        assert self._process.wait(timeout=1800) == 0, self.said()
        folder = self._project / "results" / "studies" / self._name
        return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.csv")}


def scripts(project: Path) -> list[psutil.Process]:
    """What computes in this folder now."""
    folder = str(project / ".snakemake" / "scripts")
    processes = psutil.process_iter(["cmdline"])
    return [each for each in processes if folder in " ".join((each.info["cmdline"] or [])[:2])]


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Path:
    """A copy of the project with few universes."""
    folder = copy_project(tmp_path_factory.mktemp("slurm"))
    design = (folder / DESIGN).read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / DESIGN).write_text("".join(design[: 1 + UNIVERSES]), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def expected(project) -> dict[str, bytes]:
    """What the campaign makes without Slurm."""
    made = Run(project, "here", ["--cores", "2"], os.environ).made()
    assert len(made) == UNIVERSES + 1, "each universe, and the table"
    return made


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with Cluster(tmp_path_factory.mktemp("cluster")) as its:
        yield its


@pytest.fixture
def start(project, expected, cluster, request):
    """Starts the campaign on the cluster under the test's name; nothing of it outlives the test."""
    runs = []

    def on_slurm() -> Run:
        arguments = ["--profile", "profiles/slurm", *HERE]
        runs.append(Run(project, request.node.name, arguments, cluster.environment))
        return runs[-1]

    yield on_slurm
    for run in runs:
        run.kill()
    cluster.clear()


def test_slurm_makes_the_same_bytes(start, expected):
    run = start()
    assert run.made() == expected
    assert run.said().count("has been submitted with SLURM jobid") == JOBS


def test_a_cancelled_job_is_done_again(start, expected, cluster):
    run = start()
    run.at_work()
    cluster.ask("scancel", cluster.jobs("running")[0])
    assert run.made() == expected
    assert run.said().count("Trying to restart job") == 1


def test_a_killed_job_is_done_again(start, expected):
    run = start()
    run.at_work().kill()
    assert run.made() == expected
    assert run.said().count("Trying to restart job") == 1


def test_a_killed_slurmd_is_replaced(start, expected, cluster):
    run = start()
    run.at_work()
    cluster.stop("slurmd", signal.SIGKILL)
    cluster.start("slurmd")
    assert run.made() == expected


def test_the_controller_may_be_away(start, expected, cluster):
    run = start()
    run.at_work()
    cluster.stop("slurmctld")
    time.sleep(15)  # longer than between two questions
    cluster.start("slurmctld")
    assert run.made() == expected


def test_a_killed_snakemake_goes_on(start, expected, cluster):
    run = start()
    run.at_work()
    run.kill()
    assert cluster.jobs("running"), "what it left in Slurm works on"
    assert start().made() == expected
