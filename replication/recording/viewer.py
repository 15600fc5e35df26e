"""The viewer's program, which here listens only to this machine and sends no usage data."""

import os
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TypeVar

import rerun_cli

T = TypeVar("T")
HERE = "127.0.0.1"
# The program itself, not the script that starts it, so that it can be terminated.
PROGRAM = Path(str(rerun_cli.__file__)).with_name("rerun")
PATIENCE = 60.0  # seconds for starting and loading, with a software driver on a busy machine


def quiet() -> dict[str, str]:
    """The environment in which the viewer neither records its user nor sends usage data.

    The only setting for this is a file in the home folder, but in CI the viewer does neither.
    """
    return os.environ | {"CI": "true"}


@contextmanager
def viewer(
    *options: str, log: int | IO[str] = subprocess.DEVNULL
) -> Iterator[subprocess.Popen[bytes]]:
    """Run the program with these options until the end of the block."""
    command = [str(PROGRAM), "--bind", HERE, *options]
    process = subprocess.Popen(command, env=quiet(), stdout=log, stderr=log)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def answer(process: subprocess.Popen[bytes], ask: Callable[[], T]) -> T:
    """The answer, once the program listens. Raises ConnectionError if it ends or never listens."""
    deadline = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < deadline:
        try:
            return ask()
        except (OSError, RuntimeError):
            time.sleep(0.05)
    raise ConnectionError


def free_port() -> str:
    """The number of a port that no program uses."""
    with socket.socket() as free:
        free.bind((HERE, 0))
        return str(free.getsockname()[1])
