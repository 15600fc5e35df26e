"""Allow one run at a time in a study's folder of results; different studies may run in parallel.

A file in each folder also identifies the Snakemake records that belong to its results.
"""

import fcntl
import os
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

from recalib.errors import RecalibError
from recalib.files.storage import is_temporary

MARK = ".running"
NOTES = ".snakemake/identity"  # identity of Snakemake's records; deleted together with them
OTHERS = "studies"  # folder of other studies' results, in that of the shipped study


def check_writable(folder: str) -> None:
    """Raise RecalibError if no file can be created in a folder, which need not exist yet."""
    path = Path(folder).absolute()
    existing = path if path.exists() else path.parent
    if not os.access(existing, os.W_OK):
        raise RecalibError(f"nothing can be written in {existing}; try: a copy of the project")


def check_known(folder: str) -> None:
    """Raise RecalibError for results whose Snakemake records were deleted, or are elsewhere."""
    if _read(f"{folder}/{MARK}") not in ("", _read(NOTES)):
        raise RecalibError(
            f".snakemake has no records of the results in {folder}, so Snakemake cannot tell"
            f" whether they are up to date; try: remove {folder} or, if nothing has changed"
            f" since, {folder}/{MARK}"
        )


def _read(path: str) -> str:
    with suppress(FileNotFoundError):
        return Path(path).read_text(encoding="ascii")
    return ""


def _identity() -> str:
    """The identity of Snakemake's records in the working directory."""
    with Path(NOTES).open("a+", encoding="ascii") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        if not (identity := file.read()):
            identity = uuid4().hex
            file.write(identity)
        return identity


def hold(folder: str) -> None:
    """Lock a folder until this process ends, clean it up, and write the identity of its records.

    The system releases the lock, however the process ends. Raises RecalibError if it is locked.
    """
    Path(folder).mkdir(parents=True, exist_ok=True)
    mark = os.open(Path(folder, MARK), os.O_WRONLY | os.O_CREAT, 0o666)  # never closed: the lock
    try:
        fcntl.flock(mark, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(mark)
        busy = f"another run is at work in {folder}: wait until it has ended"
        raise RecalibError(busy) from None
    os.truncate(mark, 0)
    os.write(mark, _identity().encode("ascii"))
    # remove temporary files of a killed run
    for path, folders, files in os.walk(folder):
        if path == folder and OTHERS in folders:
            folders.remove(OTHERS)
        for file in filter(is_temporary, files):
            Path(path, file).unlink(missing_ok=True)
