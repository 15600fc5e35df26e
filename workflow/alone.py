"""One run at a time in a study's folder of results; runs of different studies go side by side."""

import fcntl
from collections.abc import Iterable
from pathlib import Path

from recalib.errors import RecalibError

MARK = ".running"
_held = []  # open files: the system lets go of them when the process ends, however it ends


class Busy(RecalibError):
    """Another run works in the same folder."""

    def __init__(self, folder: str):
        self.folder = folder
        super().__init__(f"another run is at work in {folder}: wait until it has ended")


def hold(folders: Iterable[str]) -> None:
    """Keep other runs out of these folders until this process ends. Raises Busy."""
    for folder in folders:
        Path(folder).mkdir(parents=True, exist_ok=True)
        mark = Path(folder, MARK).open("a", encoding="utf-8")  # noqa: SIM115 held to the end
        try:
            fcntl.flock(mark, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Busy(folder) from None
        _held.append(mark)
