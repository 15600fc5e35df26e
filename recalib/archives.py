"""Archives of named arrays in groups, with a header: NumPy's .npz, whole or not at all."""

import json
import zipfile
from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np

from recalib.errors import InvalidFile
from recalib.interfaces import State
from recalib.storage import whole


def write_archive(path: str | PathLike, header: Mapping[str, Any], groups: State) -> None:
    """Write arrays, named by their groups as in position/theta.

    Args:
        header: of JSON's types, with the `format` and its `version`.
    """
    with whole(path) as temporary:
        np.savez(temporary, header=json.dumps(header), **flat(groups))


def read_archive(
    path: str | PathLike, kind: tuple[str, int], writer: str
) -> tuple[dict[str, Any], State]:
    """Header and groups of an archive.

    Args:
        kind: its format and version, as they must be.
        writer: what writes such archives, for messages.

    Raises InvalidFile: not whole, or not of this format.
    """
    try:
        with open(path, "rb") as stream, np.load(stream) as file:
            arrays = {name: file[name][()] for name in file.files}
        header = json.loads(str(arrays.pop("header")))
        found = header["format"], header["version"]
    except (AttributeError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile):
        raise InvalidFile(path, f"it is not whole, or not written by {writer}") from None
    if any(array.dtype.kind == "f" and not np.isfinite(array).all() for array in arrays.values()):
        raise InvalidFile(path, "it holds numbers that are none")
    if found != kind:
        raise InvalidFile(path, f"it is of format {found}; valid: {kind}")
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
