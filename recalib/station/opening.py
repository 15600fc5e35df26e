"""Stations by what stands on the command line: a Python class, or a program."""

import importlib
import importlib.util
import re
import shlex
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from recalib.station.interface import Station, StationFailed
from recalib.station.program import ProgramStation

_CLASS = re.compile(r"(?P<home>[^\s:]+):(?P<name>\w+)")


def open_station(text: str) -> Station:
    """The station that a text means.

    It is `FILE.py:NAME` or `MODULE:NAME`, where NAME is called without arguments; else the command
    line of a program.

    Raises StationFailed: there is none, or it cannot be made.
    """
    if not (named := _CLASS.fullmatch(text)):
        try:
            command = shlex.split(text)
        except ValueError as error:
            raise StationFailed(f"{text!r} is not a command line: {error}") from None
        if not command:
            raise StationFailed("STATION is empty; expected: FILE.py:NAME, or a command line")
        if len(command) == 1 and _lacks_a_name(command[0]):
            raise StationFailed(f"{text} lacks the NAME of a class; expected: FILE.py:NAME")
        return ProgramStation(command)
    try:
        make: Callable[[], Station] = getattr(_module(named["home"]), named["name"])
        return make()
    except StationFailed:
        raise
    except Exception as error:  # of code that is not ours
        raise StationFailed(f"{text} cannot be made: {type(error).__name__}: {error}") from error


def _lacks_a_name(text: str) -> bool:
    """Whether it is a file of Python, or a module with a colon, and no program."""
    return text.endswith(":") or (text.endswith(".py") and shutil.which(text) is None)


def _module(home: str) -> ModuleType:
    path = Path(home)
    if path.suffix != ".py":
        return importlib.import_module(home)
    if not path.is_file():
        raise StationFailed(f"there is no file {home}; expected: FILE.py:NAME")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    sys.path.insert(0, str(path.parent.resolve()))  # as of a script: it may import its neighbours
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
