"""Files that are read whole or refused, and files that appear whole or not at all."""

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from recalib.errors import InvalidFile

IN_THE_MAKING = ".part"


def read_file(path: str | os.PathLike[str], most: int) -> bytes:
    """The bytes of a file.

    Args:
        most: the largest size that is read [bytes].

    Raises InvalidFile: no such file, one that cannot be read or has no end, or a larger one.
    """
    try:
        mode = os.stat(path).st_mode
        if stat.S_IFMT(mode) not in (stat.S_IFREG, stat.S_IFDIR):
            kind = "pipe" if stat.S_ISFIFO(mode) else "device"
            raise InvalidFile(path, f"it is a {kind}; expected: a regular file")
        with open(path, "rb") as stream:
            content = stream.read(most + 1)
            size = max(os.fstat(stream.fileno()).st_size, len(content))
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise InvalidFile(path, getattr(error, "strerror", None) or "it cannot be read") from None
    if size > most:
        found = f"it has {size / 1e6:.3g} MB"
        raise InvalidFile(path, f"{found}; expected: at most {most / 1e6:.3g} MB")
    return content


def digest(content: bytes) -> str:
    """The first sixteen digits of the SHA-256 of a file's content."""
    return hashlib.sha256(content).hexdigest()[:16]


@contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path in the folder of `path`, with the same suffix.

    It replaces `path` when the block ends without an error.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{IN_THE_MAKING}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def is_temporary(name: str) -> bool:
    """Whether a file of this name was not complete when its process was killed."""
    return name.startswith(".") and IN_THE_MAKING in name
