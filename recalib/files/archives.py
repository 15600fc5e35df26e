"""Archives of named arrays in groups, with a header: NumPy's .npz, whole or not at all."""

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

MOST = 256_000_000  # bytes of an archive, packed and unpacked
Arrays = Mapping[str, Any]  # arrays, or further groups, by name


@contextmanager
def refused(path: str | PathLike[str], writer: str) -> Iterator[None]:
    """Raise InvalidFile in place of any exception that is not ours: a file may hold anything."""
    try:
        yield
    except RecalibError:
        raise
    except Exception:
        raise InvalidFile(path, f"it is not whole, or not written by {writer}") from None


def write_archive(path: str | PathLike[str], header: Mapping[str, Any], groups: Arrays) -> None:
    """Write an archive; see `archive_of`."""
    with whole(path) as temporary:
        temporary.write_bytes(archive_of(header, groups))


def archive_of(header: Mapping[str, Any], groups: Arrays) -> bytes:
    """The archive of arrays, named by their groups as in position/theta.

    The header is of JSON's types, with the `format` and its `version`.
    """
    arrays = flat(groups)
    sealed = {**header, "sha256": _digest(header, arrays)}
    content, members = io.BytesIO(), {"header": np.array(json.dumps(sealed)), **arrays}
    np.savez(content, **members)  # type: ignore[arg-type]  # mypy takes a member for an option
    return content.getvalue()


def read_archive(
    path: str | PathLike[str], kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], Arrays]:
    """Header and groups of the archive at `path`; see `opened`. Raises InvalidFile."""
    return opened(read_file(path, MOST), path, kind, writer)


def opened(
    archive: bytes, path: str | PathLike[str], kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], Arrays]:
    """Header and groups of an archive, whose kind is a format and its version.

    The file's path and what writes such archives are for messages. Raises InvalidFile: not whole,
    or of another kind.
    """
    content = io.BytesIO(archive)
    with refused(path, writer):
        with zipfile.ZipFile(content) as packed:
            size = sum(member.file_size for member in packed.infolist())
        if size > MOST:
            raise InvalidFile(path, f"it unpacks to {size / 1e6:.3g} MB; expected: {MOST / 1e6:g}")
        with np.load(content) as file:
            arrays = {name: file[name] for name in file.files}
        header = json.loads(str(arrays.pop("header")[()]))
        found, digest = (header["format"], header["version"]), header.pop("sha256", None)
    if found != kind:
        raise InvalidFile(path, f"it is of format {found}; expected: {kind}")
    with refused(path, writer):
        if digest != _digest(header, arrays):
            raise ValueError
    if any(array.dtype.kind == "f" and not np.isfinite(array).all() for array in arrays.values()):
        raise InvalidFile(path, "it holds numbers that are not finite")
    return header, _nested({name: array[()] for name, array in arrays.items()})


def _digest(header: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> str:
    """The SHA-256 of all members: a zip's own sums notice damage, not another member."""
    digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
    for name, array in sorted(arrays.items()):
        digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


def flat(state: Arrays, prefix: str = "") -> dict[str, np.ndarray]:
    """Arrays by their paths in groups, such as position/theta."""
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
