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
    """What must hold does not."""


def expect(holds: object, what: str) -> None:
    """Raise Broken, with what was expected, unless it holds."""
    if not holds:
        raise Broken(what)


def wait_until(what: str, holds: Callable[[], object]) -> None:
    """Wait until it holds. Raises Broken, which says what was waited for."""
    deadline = time.monotonic() + PATIENCE
    while not holds():
        expect(time.monotonic() < deadline, f"{what} within {PATIENCE} s")
        time.sleep(0.05)


@dataclass
class Outcome:
    """How a run ended: its exit code and all of its output."""

    code: int
    output: str

    def expect_success(self) -> "Outcome":
        """Expect that it ended well."""
        expect(self.code == 0, f"it ends well, but its output is {self.output}")
        return self

    def expect_failure(self) -> "Outcome":
        """Expect that it ended with an error, and without a traceback."""
        expect(self.code != 0, f"it fails, but its output is {self.output}")
        expect("Traceback" not in self.output, f"it fails without a traceback: {self.output}")
        return self

    def expect_refusal(self, sentence: str) -> "Outcome":
        """Expect that it ended with an error and that a sentence is in its output."""
        output = self.expect_failure().output
        expect(sentence in output, f"{sentence!r} is in its output, but this is {output}")
        return self


class Project:
    """A copy of the project in a folder that is there, for the results of the study of a name.

    Every call of Snakemake is given what is `given`.
    """

    def __init__(self, folder: Path, *given: str, name: str = ""):
        self.folder, self.given = copy_project(folder), given
        self.results = folder / "results" / "studies" / name

    def start(self, *arguments: str, before=(), **options) -> subprocess.Popen:
        """Begin a run in a group of processes of its own."""
        defaults = {
            "cwd": self.folder,
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
            "encoding": "utf-8",
            "start_new_session": True,
        }
        command = [*before, sys.executable, "-m", "snakemake", *self.given, *arguments]
        return subprocess.Popen(command, **defaults | options)

    def run(
        self, *arguments: str, environment: Mapping[str, str | None] = (), **options
    ) -> Outcome:
        """Run to the end; None takes a variable out of the environment."""
        changed = os.environ | dict(environment)
        variables = {key: value for key, value in changed.items() if value is not None}
        return outcome_of(self.start(*arguments, env=variables, **options))


def outcome_of(process: subprocess.Popen) -> Outcome:
    """The outcome of a run that was started; waits for its end."""
    output, _ = process.communicate(timeout=PATIENCE)
    return Outcome(process.returncode, output)


def kill(process: subprocess.Popen) -> None:
    """End a run with all its processes at once."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
