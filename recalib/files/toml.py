"""TOML files that people write."""

import tomllib
from os import PathLike
from typing import Any

from recalib.errors import InvalidFile
from recalib.files.storage import read_file

MOST = 16_000  # bytes: tomllib's memory grows with the square of the parts of a key


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """The content of the TOML at `path`. Raises InvalidFile, with the line of a mistake."""
    try:
        parts = tomllib.loads(read_file(path, MOST).decode("utf-8"))
        repr(parts)  # as a message would show them: parts of parts may be too many
        return parts
    except ValueError as error:  # not UTF-8, or not TOML
        raise InvalidFile(path, f"it is not TOML: {error}") from None
    except RecursionError:
        raise InvalidFile(path, "its parts are nested too deep") from None
