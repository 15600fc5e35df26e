"""A station that is a program of any language: one JSON object a line on its standard streams."""

import json
import subprocess
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, cast

import numpy as np

from recalib.station.interface import StationFailed

LONGEST = 1_000_000  # letters of an answer
SHOWN = 80  # letters of an answer that is none
PATIENCE = 5.0  # s that a program has to end by itself


class ProgramStation:
    """A station in another program, with a line for each request and answer.

    Requests are `{"do": "describe"}`, `{"do": "move", "angles": [...], "speed": 0.2}`,
    `{"do": "angles"}` and `{"do": "measure"}`; docs/live.md has the answers. `{"do": "stop"}` comes
    at any time, even during a move, without an answer. The program must stop the arm when its
    input ends. Its stderr is passed on.

    Args:
        command: the program and its arguments.

    Raises StationFailed: it does not start, or does not describe itself.
    """

    def __init__(self, command: Sequence[str]):
        self._name = command[0]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                errors="replace",
                # a Ctrl-C in the terminal is for us alone: a program that it ended could not stop
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
        """See `Station.move`."""
        self._ask("move", angles=angles.tolist(), speed=speed)

    def angles(self) -> np.ndarray:
        """See `Station.angles`."""
        return cast(np.ndarray, self._ask("angles", "angles")["angles"])  # checked by the caller

    def measure(self) -> Mapping[str, float | str] | None:
        """See `Station.measure`."""
        return cast(Mapping[str, float | str] | None, self._ask("measure", "row")["row"])

    def stop(self) -> None:
        """See `Station.stop`."""
        with suppress(OSError, ValueError):  # it has ended, or its input is closed
            self._send("stop")

    def close(self) -> None:
        """End the program, by the end of its input or else by force."""
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
        """The answer to a request, which has these keys."""
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
                " in a line. Messages for people belong on stderr"
            )
        if "error" in answer:
            raise StationFailed(f"{self._name}: {answer['error']}")
        for key in keys:
            if key not in answer:
                raise StationFailed(f"{self._name} answered {do!r} without {key!r}")
        return answer
