"""One run at a time in a study's folder of results; runs of different studies go side by side.

Each folder also knows which of Snakemake's notes say from what its results were made.
"""

import fcntl
import os
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

from recalib.errors import RecalibError
from recalib.files.storage import is_temporary

MARK = ".running"
NOTES = ".snakemake/identity"  # deleted with all else that Snakemake has noted
OTHERS = "studies"  # below the shipped study's folder lie those of the others


def check_writable(folder: str) -> None:
    """Raise RecalibError where no file can be made; the folder itself need not be there yet."""
    path = Path(folder).absolute()
    existing = path if path.exists() else path.parent
    if not os.access(existing, os.W_OK):
        raise RecalibError(f"nothing can be written in {existing}; try: a copy of the project")


def check_known(folder: str) -> None:
    """Raise RecalibError for results whose notes were deleted, or left elsewhere."""
    if _read(f"{folder}/{MARK}") not in ("", _read(NOTES)):
        raise RecalibError(
            f"{folder} was made by runs that .snakemake knows nothing of, so that nobody can"
            f" say whether it is up to date; try: remove {folder}, or, if nothing was changed"
            f" since, {folder}/{MARK}"
        )


def _read(path: str) -> str:
    with suppress(FileNotFoundError):
        return Path(path).read_text(encoding="ascii")
    return ""


def _identity() -> str:
    """Of Snakemake's notes in this folder."""
    with Path(NOTES).open("a+", encoding="ascii") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        if not (identity := file.read()):
            identity = uuid4().hex
            file.write(identity)
        return identity


def hold(folder: str) -> None:
    """Keep other runs out of a folder until this process ends, tidy it up, and note whose it is.

    The system lets go of it, however the process ends. Raises RecalibError: another run has it.
    """
    Path(folder).mkdir(parents=True, exist_ok=True)
    mark = os.open(Path(folder, MARK), os.O_WRONLY | os.O_CREAT, 0o666)  # held to the end
    try:
        fcntl.flock(mark, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(mark)
        busy = f"another run is at work in {folder}: wait until it has ended"
        raise RecalibError(busy) from None
    os.truncate(mark, 0)
    os.write(mark, _identity().encode("ascii"))
    # remove what a killed run left in the making
    for path, folders, files in os.walk(folder):
        if path == folder and OTHERS in folders:
            folders.remove(OTHERS)
        for file in filter(is_temporary, files):
            Path(path, file).unlink(missing_ok=True)
