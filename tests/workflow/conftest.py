"""The workflow in a copy of the project: a run of the small study, killed and then continued.

That a killed run goes on is tested, too, and takes no run of its own.
"""

import shutil
from pathlib import Path
from typing import NamedTuple

import pytest
from snakemake.api import SnakemakeApi
from snakemake.settings.types import OutputSettings, Quietness, ResourceSettings

from replication.running import LOCK
from tests.conftest import ROOT
from tests.faults.project import Project, kill, wait_until

CORES = "--cores", "2"
READ = "Makefile", "config.yaml", LOCK, "workflow/expected.csv", "workflow/real/ur5.toml"
SMALL = *CORES, "--configfile", "tests/tiny.yaml"


class Killed(NamedTuple):
    """A copy of the project whose run was killed."""

    project: Project
    done: dict[Path, int]  # when each history was written that was there by then [ns]


@pytest.fixture(scope="session")
def rules() -> list:
    """The rules of the shipped study, as Snakemake reads them."""
    with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
        workflow = api.workflow(
            ResourceSettings(cores=1), snakefile=ROOT / "Snakefile", workdir=ROOT
        )
        return list(workflow._workflow.rules)


@pytest.fixture
def with_studies(tmp_path) -> Path:
    """What make and the reading of studies see of the project."""
    for part in READ:
        (tmp_path / part).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / part, tmp_path / part)
    shutil.copytree(ROOT / "workflow" / "studies", tmp_path / "workflow" / "studies")
    return tmp_path


@pytest.fixture(scope="session")
def killed(tmp_path_factory, controller) -> Killed:
    """A run of the small study, killed with all its jobs as soon as the trainings are done.

    What a controller needs is compiled by now, so that the copy has it: no job compiles it again.
    """
    project = Project(tmp_path_factory.mktemp("project"), *SMALL, name="tiny")
    run = project.start()

    def summarised() -> bool:
        assert run.poll() is None, "the run ended before it could be interrupted"
        return (project.results / "summary.csv").exists()

    wait_until("all trainings are done", summarised)
    kill(run)
    done = (project.results / "runs").rglob("*.parquet")
    return Killed(project, {path: path.stat().st_mtime_ns for path in done})


@pytest.fixture(scope="session")
def continued(killed) -> Project:
    """The same copy of the project, its run started again, and ended."""
    killed.project.run().expect_success()
    return killed.project
