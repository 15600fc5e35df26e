"""What compiled libraries write to stderr, which no `sys.stderr` of Python's sees."""

import os
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager

STDERR = 2  # its descriptor, which a whole process shares
_ONE = threading.Lock()  # for one block at a time


@contextmanager
def caught_messages() -> Iterator[list[str]]:
    """The lines that the block writes to stderr, in place of writing them; filled when it ends.

    Commands tell a mistake in one sentence: lines for a library's developers hide it.
    """
    lines: list[str] = []
    with _ONE, tempfile.TemporaryFile() as file:
        try:
            before = os.dup(STDERR)
        except OSError:  # it is closed, so nothing is written there
            yield lines
            return
        os.dup2(file.fileno(), STDERR)
        try:
            yield lines
        finally:
            os.dup2(before, STDERR)
            os.close(before)
            file.seek(0)
            lines += file.read().decode(errors="replace").splitlines()
