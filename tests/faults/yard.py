"""Copies of the project in which something goes wrong, and what must hold nevertheless."""

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import psutil

from recalib.storage import is_temporary
from tests.conftest import copy_project

STUDY = ["--configfile", "tests/faults/study.yaml"]
RESULTS = Path("results/studies/faults")
PATIENCE = 1200  # s, for what takes ten on a quiet machine
UNLIKE = {"recordings", "report"}  # identities of rows, names of folders: not equal byte for byte


class Broken(Exception):
    """What must hold does not.

    Args:
        what: was expected.
        said: what the run said.
    """

    def __init__(self, what: str, said: str = ""):
        self.what, self.said = what, said
        super().__init__(what)


class NotTried(Exception):
    """This machine lacks what the fault needs."""


def expect(holds: object, what: str, said: str = "") -> None:
    """Raise Broken, with what was expected, unless it holds."""
    if not holds:
        raise Broken(what, said)


@dataclass
class Ran:
    """How a run ended, and all that it said."""

    code: int
    said: str

    def well(self) -> "Ran":
        """Expect that it ended well."""
        expect(self.code == 0, "it ends well", self.said)
        return self

    def badly(self) -> "Ran":
        """Expect that it ended with an error, and without a traceback."""
        expect(self.code != 0, "it fails", self.said)
        expect("Traceback" not in self.said, "it fails without a traceback", self.said)
        return self

    def told(self, sentence: str) -> "Ran":
        """Expect that it ended with a sentence."""
        expect(sentence in self.badly().said, f"it says {sentence!r}", self.said)
        return self


class Project:
    """A copy of the project.

    Args:
        folder: where it is.
        cores: of a run.
    """

    def __init__(self, folder: Path, cores: int):
        self.folder, self.cores, self.results = folder, cores, folder / RESULTS

    def start(self, *arguments: str, study=STUDY, before=(), **options) -> subprocess.Popen:
        """Begin a run in a group of processes of its own."""
        snakemake = [sys.executable, "-m", "snakemake", "--cores", str(self.cores)]
        return subprocess.Popen(
            [*before, *snakemake, *study, *arguments],
            **{
                "cwd": self.folder,
                "stdin": subprocess.DEVNULL,
                "stdout": subprocess.PIPE,
                "stderr": subprocess.STDOUT,
                "text": True,
                "encoding": "utf-8",
                "start_new_session": True,
                **options,
            },
        )

    def at_work(self, *arguments: str) -> subprocess.Popen:
        """Begin a run, and wait until its first jobs are at work."""
        process = self.start(*arguments)
        deadline = time.monotonic() + PATIENCE
        while process.poll() is None and not self.scripts():
            expect(time.monotonic() < deadline, f"goes on within {PATIENCE} s")
            time.sleep(0.05)
        return process

    def run(self, *arguments: str, environment: Mapping[str, str | None] = (), **options) -> Ran:
        """Run to the end; None takes a variable out of the environment."""
        changed = os.environ | dict(environment)
        variables = {key: value for key, value in changed.items() if value is not None}
        return self.ended(self.start(*arguments, env=variables, **options))

    @staticmethod
    def ended(process: subprocess.Popen) -> Ran:
        """How a run ends that was begun."""
        said, _ = process.communicate(timeout=PATIENCE)
        return Ran(process.returncode, said)

    def scripts(self) -> list[psutil.Process]:
        """The jobs at work here."""
        folder = str(self.folder / ".snakemake" / "scripts")
        running = psutil.process_iter(["cmdline"])
        return [each for each in running if folder in " ".join((each.info["cmdline"] or [])[:2])]

    def whole(self) -> None:
        """Expect that no file is a stray."""
        strays = [path for path in self.folder.rglob(".*") if is_temporary(path.name)]
        expect(not strays, f"no strays, but {strays}")

    def made(self, below: Path = RESULTS) -> dict[str, str]:
        """By path below a study's results, digests of what must be the same in every run."""
        folder = self.folder / below
        return {
            path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*"))
            if path.is_file()
            and not any(part.startswith(".") for part in path.relative_to(folder).parts)
            and not UNLIKE & {*path.relative_to(folder).parts}
        }


class Yard:
    """Gives each fault a copy of the project, and knows what an undisturbed run makes.

    Args:
        folder: of all copies.
        cores: of a run.
    """

    def __init__(self, folder: Path, cores: int):
        self._folder, self._cores, self._copies = folder, cores, 0

    def bare(self, name: str = "project") -> Project:
        """A copy without results."""
        self._copies += 1
        folder = self._folder / str(self._copies) / name
        folder.mkdir(parents=True)
        return Project(copy_project(folder), self._cores)

    def done(self, name: str = "project") -> Project:
        """A copy with results."""
        copy = self.bare(name)
        for part in (".snakemake", "results"):
            shutil.copytree(self._undisturbed.folder / part, copy.folder / part)
        return copy

    @cached_property
    def _undisturbed(self) -> Project:
        project = self.bare()
        project.run().well()
        return project

    @cached_property
    def expected(self) -> dict[str, str]:
        """What an undisturbed run makes."""
        return self._undisturbed.made()

    def finished(self, project: Project) -> None:
        """Expect of a project what an undisturbed run makes, and nothing else."""
        project.whole()
        made = project.made()
        unlike = sorted(
            path for path in self.expected | made if self.expected.get(path) != made.get(path)
        )
        expect(not unlike, f"the results of an undisturbed run, but {', '.join(unlike)}")


def kill(process: subprocess.Popen) -> None:
    """End a run with all its processes at once."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
