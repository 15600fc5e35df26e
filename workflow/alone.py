"""One run at a time in a study's folder of results; runs of different studies go side by side."""

import fcntl
import os
from collections.abc import Iterable
from pathlib import Path

from recalib.errors import RecalibError
from recalib.storage import is_temporary

MARK = ".running"
OTHERS = "studies"  # below the shipped study's folder lie those of the others
_held = []  # open files: the system lets go of them when the process ends, however it ends


class Busy(RecalibError):
    """Another run works in the same folder."""

    def __init__(self, folder: str):
        self.folder = folder
        super().__init__(f"another run is at work in {folder}: wait until it has ended")


def hold(folders: Iterable[str]) -> None:
    """Keep other runs out of these folders until this process ends, and tidy them up.

    Raises Busy.
    """
    for folder in folders:
        Path(folder).mkdir(parents=True, exist_ok=True)
        mark = Path(folder, MARK).open("a", encoding="utf-8")  # noqa: SIM115 held to the end
        try:
            fcntl.flock(mark, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Busy(folder) from None
        _held.append(mark)
        sweep(folder)


def sweep(folder: str) -> None:
    """Remove what a killed run left in the making."""
    for path, folders, files in os.walk(folder):
        if path == folder and OTHERS in folders:
            folders.remove(OTHERS)
        for file in filter(is_temporary, files):
            Path(path, file).unlink(missing_ok=True)
