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

MOST = 256_000_000  # bytes, also of what is packed
Arrays = Mapping[str, Any]  # by name, in groups of groups


@contextmanager
def refused(path: str | PathLike[str], writer: str) -> Iterator[None]:
    """Blame the file for whatever is raised while it is read: it may hold anything.

    Raises InvalidFile, or what was raised on purpose.
    """
    try:
        yield
    except RecalibError:
        raise
    except Exception:
        raise InvalidFile(path, f"it is not whole, or not written by {writer}") from None


def write_archive(path: str | PathLike[str], header: Mapping[str, Any], groups: Arrays) -> None:
    """Write arrays, named by their groups as in position/theta.

    Args:
        header: of JSON's types, with the `format` and its `version`.
    """
    arrays = flat(groups)
    sealed = {**header, "sha256": _digest(header, arrays)}
    with whole(path) as temporary:
        members: dict[str, Any] = {"header": json.dumps(sealed), **arrays}
        np.savez(temporary, **members)


def read_archive(
    path: str | PathLike[str], kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], Arrays]:
    """Header and groups of an archive.

    Args:
        kind: its format and version, as they must be.
        writer: what writes such archives, for messages.

    Raises InvalidFile: not there, not whole, or not of this format.
    """
    content = io.BytesIO(read_file(path, MOST))
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
    """Of all that an archive holds: its sums tell a damaged part, not one that was replaced."""
    digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
    for name, array in sorted(arrays.items()):
        digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


def flat(state: Arrays, prefix: str = "") -> dict[str, np.ndarray]:
    """The arrays of a state by their paths, such as position/theta."""
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
