"""Opening of the station that the command line names: a Python class, or any program.

A program reads and writes one JSON object per line on its standard streams.
"""

import importlib
import importlib.util
import json
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from recalib.errors import InvalidSetting
from recalib.station.interface import Station, StationFailed

_CLASS = re.compile(r"(?P<home>[^\s:]+):(?P<name>\w+)")
LONGEST = 1_000_000  # characters of an answer
SHOWN = 80  # characters of an invalid answer in a message
PATIENCE = 5.0  # s, the time for a program to end by itself


def open_station(text: str) -> Station:
    """The station that a text names.

    The text is `FILE.py:NAME` or `MODULE:NAME`, where NAME is called without arguments; otherwise
    it is the command line of a program.

    Raises StationFailed: there is no such station, or it cannot be made.
    """
    if not (named := _CLASS.fullmatch(text)):
        try:
            command = shlex.split(text)
        except ValueError as error:
            raise StationFailed(f"{text!r} is not a command line: {error}") from None
        if not command:
            raise StationFailed("STATION is empty; expected: FILE.py:NAME, or a command line")
        word, *others = command
        is_file = word.endswith(".py") and shutil.which(word) is None  # and not a command
        if not others and (is_file or word.endswith(":")):
            raise StationFailed(f"{text} has no NAME of a class; expected: FILE.py:NAME")
        return ProgramStation(command)
    try:
        return getattr(_module(named["home"]), named["name"])()
    except StationFailed:
        raise
    except Exception as error:  # the user's code may raise anything
        raise StationFailed(f"{text} cannot be made: {type(error).__name__}: {error}") from error


def _module(home: str) -> ModuleType:
    path = Path(home)
    if path.suffix != ".py":
        return importlib.import_module(home)
    if not path.is_file():
        raise StationFailed(f"there is no file {home}; expected: FILE.py:NAME")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    sys.path.insert(0, str(path.parent.resolve()))  # as for a script: it may import its neighbours
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class ProgramStation:
    """A station in another program, with one line for each request and each answer.

    Requests are `{"do": "describe"}`, `{"do": "move", "angles": [...], "speed": 0.2}`,
    `{"do": "angles"}` and `{"do": "measure"}`; docs/live.md has the answers. `{"do": "stop"}` comes
    at any time, even during a move, without an answer. The program must stop the arm when its
    input ends. Its stderr is passed on.

    Args:
        command: the program and its arguments, such as ["node", "station.js"].

    Raises StationFailed: the program does not start, or does not describe itself; InvalidSetting:
    no such command.
    """

    def __init__(self, command: Sequence[str]):
        words = [] if isinstance(command, str) or not isinstance(command, Sequence) else command
        if not words or not all(isinstance(word, str) and "\0" not in word for word in words):
            raise InvalidSetting("command", command, 'words such as ["node", "station.js"]')
        self._name = command[0]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                errors="replace",
                # a Ctrl-C must not reach the program, which could then no longer stop the arm
                start_new_session=True,
            )
        except OSError as error:
            raise StationFailed(f"{self._name} does not start: {error.strerror}") from None
        try:
            described = self._ask("describe", "joints", "lower", "upper")
        except StationFailed:
            self.close()
            raise
        self.joints: Sequence[str] = described["joints"]
        self.limits: tuple[np.ndarray, np.ndarray] = described["lower"], described["upper"]

    def move(self, angles: np.ndarray, speed: float) -> None:
        self._ask("move", angles=angles.tolist(), speed=speed)

    def angles(self) -> np.ndarray:
        return self._ask("angles", "angles")["angles"]  # checked by the caller

    def measure(self) -> Mapping[str, float | str] | None:
        return self._ask("measure", "row")["row"]

    def stop(self) -> None:
        with suppress(OSError, ValueError):  # the program has ended, or its input is closed
            self._send("stop")

    def close(self) -> None:
        """End the program by closing its input, or else by force."""
        assert self._process.stdin and self._process.stdout
        with suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def _send(self, do: str, **more: Any) -> None:
        assert self._process.stdin
        self._process.stdin.write(json.dumps({"do": do, **more}) + "\n")
        self._process.stdin.flush()

    def _ask(self, do: str, *keys: str, **more: Any) -> dict[str, Any]:
        """The answer to a request; StationFailed if it lacks one of the keys."""
        assert self._process.stdout
        try:
            self._send(do, **more)
            line = self._process.stdout.readline(LONGEST)
        except (OSError, ValueError):
            line = ""
        if not line.endswith("\n"):
            raise StationFailed(f"{self._name} ended before it answered {do!r}")
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            raise StationFailed(
                f"{self._name} answered {line.strip()[:SHOWN]!r} to {do!r}; expected: a JSON object"
                " on one line. Log messages belong on stderr"
            )
        if "error" in answer:
            raise StationFailed(f"{self._name}: {answer['error']}")
        for key in keys:
            if key not in answer:
                raise StationFailed(f"{self._name} answered {do!r} without {key!r}")
        return answer
