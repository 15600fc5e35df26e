"""Files that are read completely or refused, and files that appear complete or not at all."""

import codecs
import hashlib
import os
import re
import stat
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from recalib.errors import InvalidFile, InvalidSetting

IN_THE_MAKING = ".part"
MOST_TOML = 16_000  # bytes: tomllib's memory grows with the square of the parts of a key
# The encoding of XML is declared, or its first bytes mark it.
_DECLARED = re.compile(rb"""\s*<\?xml[^>]*?\sencoding\s*=\s*["']([\w.-]+)["']""")
_MARKED = dict.fromkeys((codecs.BOM_UTF16_LE, b"<\0"), "utf-16-le")
_MARKED |= dict.fromkeys((codecs.BOM_UTF16_BE, b"\0<"), "utf-16-be")


def path_of(given: str | os.PathLike[str]) -> Path:
    """The given name as a path. Raises InvalidSetting: not a path, or a name that no file has."""
    if not isinstance(given, str | os.PathLike) or not os.fspath(given) or "\0" in os.fspath(given):
        raise InvalidSetting("path", given, "the name of a file or folder")
    return Path(given)


def read_file(path: str | os.PathLike[str], most: int) -> bytes:
    """The bytes of a file of at most `most` bytes.

    Raises InvalidFile: the file is missing, unreadable, too large, or no regular file.
    """
    path = path_of(path)
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


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The content of the TOML file at `path`. Raises InvalidFile, with the line of a mistake."""
    try:
        parts = tomllib.loads(read_file(path, MOST_TOML).decode("utf-8"))
        repr(parts)  # as in a message: raises RecursionError if tables are nested too deeply
        return parts
    except ValueError as error:  # not UTF-8, or not TOML
        raise InvalidFile(path, f"it is not TOML: {error}") from None
    except RecursionError:
        raise InvalidFile(path, "its tables are nested too deeply") from None


def encoding(source: bytes) -> str:
    """The encoding of XML: declared, or marked by its first bytes, or else UTF-8."""
    if declared := _DECLARED.match(source):
        return declared[1].decode("ascii")
    return _MARKED.get(source[:2], "utf-8")


def read_xml(source: bytes, path: Path) -> ElementTree.Element:
    """The root element of XML; `path` is for messages.

    Raises InvalidFile: not XML, with line and column; or not in the declared encoding.
    """
    try:
        text = source.decode(encoding(source))
        if text.encode(encoding(source)) != source:  # a corrected URDF must keep all other bytes
            raise UnicodeError
        return ElementTree.fromstring(text)
    except (LookupError, UnicodeError):
        raise InvalidFile(path, f"its text is not in {encoding(source)}") from None
    except ElementTree.ParseError as error:
        words, line, column = str(error).partition(":")[0], *error.position
        reason = f"it is not XML: line {line}, column {column}: {words}"
        raise InvalidFile(path, reason) from None


def digest(content: bytes) -> str:
    """The first sixteen hexadecimal digits of the SHA-256 of a file's content."""
    return hashlib.sha256(content).hexdigest()[:16]


@contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path in the folder of `path`, with the same suffix.

    The file there replaces `path` when the block ends without an error.

    Raises InvalidSetting: not a path; InvalidFile: no regular file, or one that cannot be written.
    """
    path = path_of(path)
    temporary = path.parent / f".{path.stem}.{os.getpid()}{IN_THE_MAKING}{path.suffix}"
    try:
        if path.exists() and not path.is_file():
            raise InvalidFile(path, "it is a folder or device; expected: the name of a file")
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise InvalidFile(path, f"it cannot be written: {error.strerror}") from None
    finally:
        with suppress(OSError):
            temporary.unlink()


def is_temporary(name: str) -> bool:
    """Whether a file of this name is an incomplete file of a killed process."""
    return name.startswith(".") and IN_THE_MAKING in name
