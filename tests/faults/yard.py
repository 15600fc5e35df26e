"""Copies of the project in which something goes wrong, and what must hold even so."""

import hashlib
import shutil
import subprocess
from functools import cached_property
from pathlib import Path

import psutil

from recalib.files.storage import is_temporary
from tests.faults.project import Project, expect, wait_until

STUDY = "--configfile", "tests/faults/study.yaml"
# Folders of files that differ between runs: identities of rows, names of folders, times.
UNLIKE = {"recordings", "logs", "settings"}


def at_work(project: Project, process: subprocess.Popen) -> list[psutil.Process]:
    """The jobs of a run as soon as some are at work; none if it ends before."""
    found, folder = [], str(project.folder / ".snakemake" / "scripts")

    def some_at_work() -> bool:
        running = psutil.process_iter(["cmdline"])
        found[:] = [job for job in running if folder in " ".join((job.info["cmdline"] or [])[:2])]
        return bool(found) or process.poll() is not None

    wait_until("a job is at work", some_at_work)
    return found


def expect_no_strays(project: Project) -> None:
    """Expect that no temporary file is left."""
    strays = [path for path in project.folder.rglob(".*") if is_temporary(path.name)]
    expect(not strays, f"no strays, but {strays}")


def digests_of(results: Path) -> dict[str, str]:
    """Digests of the files that are equal in every run, by path below a study's results."""
    paths = {path.relative_to(results): path for path in sorted(results.rglob("*"))}
    return {
        relative.as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for relative, path in paths.items()
        if path.is_file() and not UNLIKE & {*relative.parts} and not f"/{relative}".count("/.")
    }


class Yard:
    """Gives each fault a copy of the project, and has the results of an undisturbed run.

    Args:
        folder: of all copies.
    """

    def __init__(self, folder: Path):
        self._folder, self._copies = folder, 0

    def bare(self, name: str = "project") -> Project:
        """A copy without results."""
        self._copies += 1
        folder = self._folder / str(self._copies) / name
        folder.mkdir(parents=True)
        return Project(folder, "--cores", "2", *STUDY, name="faults")

    def complete(self) -> Project:
        """A copy with results."""
        copy = self.bare()
        for part in (".snakemake", "results"):
            shutil.copytree(self._undisturbed.folder / part, copy.folder / part)
        return copy

    @cached_property
    def _undisturbed(self) -> Project:
        project = self.bare()
        project.run().expect_success()
        return project

    @cached_property
    def expected(self) -> dict[str, str]:
        """The digests of the results of an undisturbed run."""
        return digests_of(self._undisturbed.results)

    def expect_results(self, project: Project) -> None:
        """Expect the results of an undisturbed run, and no other file."""
        expect_no_strays(project)
        digests = digests_of(project.results)
        different = sorted(
            path for path in self.expected | digests if self.expected.get(path) != digests.get(path)
        )
        expect(not different, f"the results of an undisturbed run, but {', '.join(different)}")
