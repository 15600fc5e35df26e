"""The viewer's program: it listens to this machine alone and sends no usage data."""

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
# Not the script that starts it, so that it can be ended.
PROGRAM = Path(str(rerun_cli.__file__)).with_name("rerun")
PATIENCE = 60.0  # seconds for it to start and to load, in software on a busy machine


def quiet() -> dict[str, str]:
    """The environment in which it neither notes who runs it nor sends that anywhere.

    It has no setting for this but a file in the home; where nobody looks on, it does neither.
    """
    return os.environ | {"CI": "true"}


@contextmanager
def viewer(
    *options: str, log: int | IO[str] = subprocess.DEVNULL
) -> Iterator[subprocess.Popen[bytes]]:
    """The program with these options, ended at the end of the block."""
    command = [str(PROGRAM), "--bind", HERE, *options]
    process = subprocess.Popen(command, env=quiet(), stdout=log, stderr=log)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def answer(process: subprocess.Popen[bytes], ask: Callable[[], T]) -> T:
    """What it answers as soon as it listens. Raises ConnectionError: it ended, or never does."""
    deadline = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < deadline:
        try:
            return ask()
        except (OSError, RuntimeError):
            time.sleep(0.05)
    raise ConnectionError


def free_port() -> str:
    """One that no program listens to."""
    with socket.socket() as free:
        free.bind((HERE, 0))
        return str(free.getsockname()[1])
