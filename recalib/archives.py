"""Archives of named arrays in groups, with a header: NumPy's .npz, whole or not at all."""

import io
import json
import zipfile
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.interfaces import State
from recalib.storage import whole

# What NumPy and zipfile raise of damaged files; RuntimeError where one seems to be encrypted.
UNREADABLE = (
    AttributeError,
    EOFError,
    KeyError,
    OSError,
    RuntimeError,
    TypeError,
    ValueError,
    zipfile.BadZipFile,
)


def write_archive(path: str | PathLike, header: Mapping[str, Any], groups: State) -> None:
    """Write arrays, named by their groups as in position/theta.

    Args:
        header: of JSON's types, with the `format` and its `version`.
    """
    arrays = flat(groups)
    with whole(path) as temporary:
        np.savez(temporary, header=json.dumps({**header, "arrays": [*arrays]}), **arrays)


def read_archive(
    path: str | PathLike, kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], State]:
    """Header and groups of an archive.

    Args:
        kind: its format and version, as they must be.
        writer: what writes such archives, for messages.

    Raises InvalidFile: not there, not whole, or not of this format.
    """
    broken = InvalidFile(path, f"it is not whole, or not written by {writer}")
    try:
        content = io.BytesIO(Path(path).read_bytes())
    except OSError as error:
        raise InvalidFile(path, error.strerror) from None
    try:
        with np.load(content) as file:
            arrays = {name: file[name][()] for name in file.files}
        header = json.loads(str(arrays.pop("header")))
        found = header["format"], header["version"]
    except UNREADABLE:
        raise broken from None
    if found != kind:
        raise InvalidFile(path, f"it is of format {found}; valid: {kind}")
    if header.pop("arrays", None) != [*arrays]:  # a damaged directory can hide some
        raise broken
    if any(array.dtype.kind == "f" and not np.isfinite(array).all() for array in arrays.values()):
        raise InvalidFile(path, "it holds numbers that are none")
    return header, _nested(arrays)


def flat(state: State, prefix: str = "") -> dict[str, np.ndarray]:
    """The arrays of a state by their paths, such as position/theta."""
    arrays = {}
    for name, value in state.items():
        if isinstance(value, Mapping):
            arrays |= flat(value, f"{prefix}{name}/")
        elif value is not None:
            arrays[prefix + name] = np.asarray(value)
    return arrays


def _nested(arrays: Mapping[str, np.ndarray]) -> State:
    state: dict[str, Any] = {}
    for path, value in arrays.items():
        *groups, name = path.split("/")
        group = state
        for each in groups:
            group = group.setdefault(each, {})
        group[name] = value
    return state
