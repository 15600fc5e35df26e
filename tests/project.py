"""A copy of the project, in which the workflow runs to its end, or does not come so far."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import copy_project

PATIENCE = 1200  # s, for what takes ten on a quiet machine


class Broken(Exception):
    """What must hold does not.

    Args:
        what: was expected.
        said: what the run said.
    """

    def __init__(self, what: str, said: str = ""):
        self.said = said
        super().__init__(what)


def expect(holds: object, what: str, said: str = "") -> None:
    """Raise Broken, with what was expected, unless it holds."""
    if not holds:
        raise Broken(what, said)


def wait_until(what: str, holds: Callable[[], object]) -> None:
    """Wait until it holds. Raises Broken, which says what was waited for."""
    deadline = time.monotonic() + PATIENCE
    while not holds():
        expect(time.monotonic() < deadline, f"{what} within {PATIENCE} s")
        time.sleep(0.05)


@dataclass
class Ran:
    """How a run ended, and all that it said."""

    code: int
    said: str

    def well(self) -> "Ran":
        """Expect that it ended well."""
        expect(self.code == 0, f"it ends well, but says {self.said}", self.said)
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
        folder: where it is to be; it is there already.
        given: what every call of Snakemake is given.
        name: of the study whose results it makes.
    """

    def __init__(self, folder: Path, *given: str, name: str = ""):
        self.folder, self.given = copy_project(folder), given
        self.results = folder / "results" / "studies" / name

    def start(self, *arguments: str, before=(), **options) -> subprocess.Popen:
        """Begin a run in a group of processes of its own."""
        its = {
            "cwd": self.folder,
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
            "encoding": "utf-8",
            "start_new_session": True,
        }
        command = [*before, sys.executable, "-m", "snakemake", *self.given, *arguments]
        return subprocess.Popen(command, **its | options)

    def run(self, *arguments: str, environment: Mapping[str, str | None] = (), **options) -> Ran:
        """Run to the end; None takes a variable out of the environment."""
        changed = os.environ | dict(environment)
        variables = {key: value for key, value in changed.items() if value is not None}
        return ended(self.start(*arguments, env=variables, **options))


def ended(process: subprocess.Popen) -> Ran:
    """How a run ends that was begun."""
    said, _ = process.communicate(timeout=PATIENCE)
    return Ran(process.returncode, said)


def kill(process: subprocess.Popen) -> None:
    """End a run with all its processes at once."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
