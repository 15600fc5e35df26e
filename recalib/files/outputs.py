"""The output of a command: complete, at once, and never in place of an existing file."""

import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.storage import IN_THE_MAKING

MARK = "made-by-recalib"  # a file in the folder of what is in the making: what lies there is ours


def check_new(path: str | os.PathLike[str], folder: bool = False) -> None:
    """Raise unless `new` may put a file, or a folder, at `path`.

    Raises InvalidSetting (no name), InvalidFile (something is there, or nothing can be put there),
    OSError (a name that no file can have).
    """
    if not os.fspath(path) or "\0" in os.fspath(path):
        raise InvalidSetting("--out", os.fspath(path), "the name of a file or folder")
    if is_taken(path, folder):
        raise InvalidFile(path, "it is there already, and nothing is replaced; try: another --out")
    top, making = _places(path)
    if not top.parent.is_dir() or not os.access(top.parent, os.W_OK):
        raise InvalidFile(path, f"nothing can be made in {top.parent}; try: another --out")
    if os.path.lexists(making) and not _is_ours(making):
        raise InvalidFile(making, "it is in the way of what will be made; try: another --out")


def is_taken(path: str | os.PathLike[str], folder: bool = False) -> bool:
    """Whether something is there that a file, or a folder, may not replace.

    A folder may replace an empty one, but not a link, another disk, or the one we are in.
    """
    path = Path(path)
    if not folder or path.is_symlink() or not path.is_dir() or os.path.ismount(path):
        return os.path.lexists(path)
    return any(path.iterdir()) or path.samefile(Path.cwd())


@contextmanager
def new(path: str | os.PathLike[str], folder: bool = False) -> Iterator[Path]:
    """Where to make a file, or a folder, which appears at `path` when the block ends well.

    It appears at once, with those of its parents that are not there, and replaces nothing. What a
    killed process left in the making goes when the next one makes the same.

    Raises as `check_new`, and InvalidFile where another process makes the same.
    """
    check_new(path, folder)
    top, making = _places(path)
    made = making / Path(os.path.abspath(path)).relative_to(top.parent)
    try:
        making.mkdir(exist_ok=True)
    except OSError as error:
        reason = f"nothing can be made in {top.parent}: {error.strerror}; try: another --out"
        raise InvalidFile(path, reason) from None
    with _held(making):
        try:
            (making / MARK).touch()
            _remove(making / top.name)
            (made if folder else made.parent).mkdir(parents=True, exist_ok=True)
            yield made
            check_new(path, folder)
            os.rename(making / top.name, top)
        finally:
            with suppress(OSError):
                _remove(making / top.name)  # before the mark, which says that it may be removed
            shutil.rmtree(making, ignore_errors=True)


def _places(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    """The uppermost part of a path that is not there, and the hidden folder in which it is made."""
    top = Path(os.path.abspath(path))
    while not os.path.lexists(top.parent):
        top = top.parent
    return top, top.with_name(f".{top.name}{IN_THE_MAKING}")


def _is_ours(making: Path) -> bool:
    """Whether a killed process left this folder: it is marked, or was not yet and is empty."""
    if making.is_symlink() or not making.is_dir():
        return False
    names = [path.name for path in making.iterdir()]
    return not names or MARK in names


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


@contextmanager
def _held(folder: Path) -> Iterator[None]:
    """Keep other processes out of a folder; the system lets go of it however this one ends."""
    other = InvalidFile(folder, "another process fills it; try: another --out")
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except FileNotFoundError:
        raise other from None
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise other from None
        if not os.fstat(descriptor).st_nlink:  # whoever filled it has removed it
            raise other
        yield
    finally:
        os.close(descriptor)
