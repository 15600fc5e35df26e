"""Output of commands: files that are new, appear complete, and are verified before they appear."""

import csv
import io
import json
import os
import shutil
import tempfile
import tomllib
import zipfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import yaml

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.storage import IN_THE_MAKING, read_xml

AnyPath = str | os.PathLike[str]
HIDDEN = ".recalib-"  # the prefix of temporary folders, before the process's number


def check_new(path: AnyPath, folder: bool = False) -> None:
    """Raise an exception if `write_new` cannot write a file, or a folder, at `path`.

    Raises InvalidSetting (an invalid name), InvalidFile (the path exists, or its folder is not
    writable), OSError (a name that is too long).
    """
    if not os.fspath(path) or "\0" in os.fspath(path):
        raise InvalidSetting("--out", os.fspath(path), "the name of a file or folder")
    if is_taken(path, folder):
        raise InvalidFile(path, "it already exists and is not replaced; try: another --out")
    home = _home(path)
    if not home.is_dir() or not os.access(home, os.W_OK):
        raise InvalidFile(path, f"the folder {home} is not writable; try: another --out")


def is_taken(path: AnyPath, folder: bool = False) -> bool:
    """Whether something exists at `path` that a file, or a folder, must not replace.

    A folder may replace an empty folder, but not a link, a mount point, or the working folder.
    """
    path = Path(path)
    if not folder or path.is_symlink() or not path.is_dir() or os.path.ismount(path):
        return os.path.lexists(path)
    return any(path.iterdir()) or path.samefile(Path.cwd())


def write_new(path: AnyPath, content: bytes | Mapping[str, bytes], suffix: str = "") -> None:
    """Write a new file, or a new folder of files by their names, and any missing parent folders.

    `suffix` determines the format of a single file, whatever its name is.

    A parser of its format reads each file back. Then everything appears at once and replaces
    nothing. Remains of a killed process are removed by the next process that writes there.

    Raises as `check_new`, and InvalidFile: a file that cannot be written or read back.
    """
    folder = not isinstance(content, bytes)
    parts = {"": content} if isinstance(content, bytes) else content
    check_new(path, folder)
    home, target = _home(path), Path(os.path.abspath(path))
    try:
        _remove_leftovers(home)
        with tempfile.TemporaryDirectory(
            prefix=f"{HIDDEN}{os.getpid()}-", suffix=IN_THE_MAKING, dir=home
        ) as temporary:
            made = Path(temporary, "made")
            if folder:
                made.mkdir()
            for name, part in parts.items():
                _write(made / name, part, Path(path, name), Path(name).suffix or suffix)
            target.parent.mkdir(parents=True, exist_ok=True)
            check_new(path, folder)
            os.rename(made, target)
    except OSError as error:
        raise InvalidFile(path, f"it cannot be written: {error.strerror}") from None


def _home(path: AnyPath) -> Path:
    """The nearest folder above a path that exists."""
    return next(parent for parent in Path(os.path.abspath(path)).parents if os.path.lexists(parent))


def _remove_leftovers(home: Path) -> None:
    """Remove the temporary folders of processes that have ended."""
    for left in home.glob(f"{HIDDEN}*{IN_THE_MAKING}"):
        number = left.name.removeprefix(HIDDEN).partition("-")[0]
        try:
            os.kill(int(number), 0)
        except (ProcessLookupError, ValueError):
            shutil.rmtree(left, ignore_errors=True)
        except OSError:  # another user's process
            pass


def _write(made: Path, content: bytes, path: AnyPath, suffix: str) -> None:
    """Write a file, and read it back; messages name the path at which it will appear."""
    try:
        made.write_bytes(content)
        same = made.read_bytes() == content
    except OSError as error:
        raise InvalidFile(path, f"it cannot be written: {error.strerror}") from None
    if not same:
        raise InvalidFile(path, "the disk returned other content than was written")
    try:
        READERS.get(suffix, bytes.decode)(content)
    except Exception as error:  # parsers raise all kinds of exceptions
        reason = f"its computed content cannot be read back: {error}; please report this"
        raise InvalidFile(path, reason) from None


def _read_csv(content: bytes) -> None:
    heading, *rows = csv.reader(io.StringIO(content.decode("utf-8"), newline=""), strict=True)
    if {len(row) for row in rows} - {len(heading)}:
        raise ValueError("its rows have different lengths")


def _read_npz(content: bytes) -> None:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if damaged := archive.testzip():
            raise ValueError(f"{damaged} is damaged")


def _read_xml(content: bytes) -> None:
    read_xml(content, Path("it"))


def _read_ending(ending: bytes, content: bytes) -> None:
    if ending not in content[-64:]:
        raise ValueError("its end is missing")


# A new format needs a line here; a file of any other format must be text in UTF-8.
READERS: Mapping[str, Callable[[bytes], object]] = {
    ".csv": _read_csv,
    ".json": json.loads,
    ".npz": _read_npz,
    ".pdf": partial(_read_ending, b"%%EOF"),
    ".rrd": partial(_read_ending, b"RRF2FOOT"),
    ".svg": _read_xml,
    ".toml": lambda content: tomllib.loads(content.decode("utf-8")),
    ".urdf": _read_xml,
    ".yaml": yaml.safe_load,
}
