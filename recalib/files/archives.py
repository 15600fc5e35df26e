"""Archives of named arrays in groups, with a header, as .npz files with a checksum."""

import hashlib
import io
import json
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from typing import Any

import numpy as np

from recalib.errors import InvalidFile, RecalibError
from recalib.files.storage import read_file, whole

MOST = 256_000_000  # bytes in an archive, packed and unpacked
Arrays = Mapping[str, Any]  # arrays, or further groups, by name


@contextmanager
def refused(path: str | PathLike[str], writer: str) -> Iterator[None]:
    """Raise InvalidFile instead of any other exception, since a file may contain anything."""
    try:
        yield
    except RecalibError:
        raise
    except Exception:
        raise InvalidFile(path, f"it is damaged, or not written by {writer}") from None


def write_archive(path: str | PathLike[str], header: Mapping[str, Any], groups: Arrays) -> None:
    """Write an archive; see `archive_of`."""
    with whole(path) as temporary:
        temporary.write_bytes(archive_of(header, groups))


def archive_of(header: Mapping[str, Any], groups: Arrays) -> bytes:
    """The bytes of an archive, whose arrays are named by their groups, such as position/theta.

    The header has JSON types, and the keys `format` and `version`.
    """
    arrays = flat(groups)
    sealed = {**header, "sha256": _digest(header, arrays)}
    content, members = io.BytesIO(), {"header": np.array(json.dumps(sealed)), **arrays}
    np.savez(content, **members)  # type: ignore[arg-type]  # mypy mistakes a member for an option
    return content.getvalue()


def read_archive(
    path: str | PathLike[str], kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], Arrays]:
    """The header and the groups of the archive at `path`; see `opened`. Raises InvalidFile."""
    return opened(read_file(path, MOST), path, kind, writer)


def opened(
    archive: bytes, path: str | PathLike[str], kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], Arrays]:
    """The header and the groups of an archive, whose kind is a format and its version.

    Messages name the path and the writer of such archives. Raises InvalidFile: damaged, or of
    another kind.
    """
    content = io.BytesIO(archive)
    with refused(path, writer):
        with zipfile.ZipFile(content) as packed:
            size = sum(member.file_size for member in packed.infolist())
        if size > MOST:
            valid = f"at most {MOST / 1e6:g} MB"
            raise InvalidFile(path, f"it unpacks to {size / 1e6:.3g} MB; expected: {valid}")
        with np.load(content) as file:
            arrays = {name: file[name] for name in file.files}
        header = json.loads(str(arrays.pop("header")[()]))
        found, digest = (header["format"], header["version"]), header.pop("sha256", None)
        if found != kind:
            raise InvalidFile(path, f"its format is {found}; expected: {kind}")
        if digest != _digest(header, arrays):
            raise ValueError
    if any(array.dtype.kind == "f" and not np.isfinite(array).all() for array in arrays.values()):
        raise InvalidFile(path, "it contains numbers that are not finite")
    return header, _nested({name: array[()] for name, array in arrays.items()})


def _digest(header: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> str:
    """The SHA-256 of all members: a zip's own checksums do not notice a replaced member."""
    digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
    for name, array in sorted(arrays.items()):
        digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


def flat(state: Arrays, prefix: str = "") -> dict[str, np.ndarray]:
    """The arrays in nested groups, by their paths, such as position/theta."""
    arrays: dict[str, np.ndarray] = {}
    for name, value in state.items():
        if isinstance(value, Mapping):
            arrays |= flat(value, f"{prefix}{name}/")
        elif value is not None:
            arrays[prefix + name] = np.asarray(value)
    return arrays


def _nested(arrays: Mapping[str, np.ndarray]) -> Arrays:
    state: dict[str, Any] = {}
    for path, value in arrays.items():
        *groups, name = path.split("/")
        group = state
        for part in groups:
            group = group.setdefault(part, {})
        group[name] = value
    return state
