"""Which code a job runs, and which files of the project it reads: editing one of them runs
again what depends on it, and nothing else.

A digest is handed to each job as a parameter. As inputs, modules would be looked at by their times,
which a checkout changes, and so often that starting jobs took longer than many of them. What a job
reads is an input as well, but what has an old date may be new all the same.
"""

import hashlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

from recalib.files.storage import digest
from replication.config.shipped import RESULTS

ROOT = Path(__file__).parents[1]
SCRIPT = "workflow/scripts/call.py"
# Read as text: to parse all modules takes longer than all else that happens at the start.
OURS = r"((?:recalib|replication|workflow)[\w.]*)"
IMPORT = re.compile(rf"^ *(?:from {OURS} import (\([^)]*\)|.*)|import {OURS})", re.MULTILINE)
NAME = re.compile(r"(\w+)(?: as \w+)?")


def calls(
    function: str, also: Callable = lambda wildcards: (), reads: Callable = lambda wildcards: ()
) -> dict:
    """The parameters of a rule that say which function it calls, and what that is made from.

    This is a digest of code, and of what is read and no rule makes. It follows from wildcards
    alone: Snakemake compares no parameter that follows from inputs.

    Args:
        function: its dotted name.
        also: gives the names of modules that it imports by a name that it is told.
        reads: gives the paths of files; results do not count among them.
    """

    def made_from(wildcards: object) -> str:
        home = function.rpartition(".")[0]
        given = [path for path in map(str, reads(wildcards)) if not path.startswith(f"{RESULTS}/")]
        return "".join([code(home, *also(wildcards)), *map(_digest, given)])

    return {"function": function, "code": made_from}


@cache
def _digest(path: str) -> str:
    """Of a file; Snakemake says it where there is none."""
    there = Path(path)
    return digest(there.read_bytes()) if there.is_file() else ""


@cache
def code(*named: str) -> str:
    """A digest of the script, of modules by their dotted names, and of all that they import."""
    parts = hashlib.sha256()
    for module in modules(*named):
        parts.update(module.encode() + b"\0" + content(module))
    return parts.hexdigest()


@cache
def modules(*named: str) -> list[str]:
    """Those modules and every module that they import, as paths below the project."""
    needed, waiting = set(), {SCRIPT}.union(*map(_files, named))
    while waiting:
        needed |= waiting
        waiting = set().union(*map(imported, waiting)) - needed
    return sorted(needed)


@cache
def imported(module: str) -> frozenset[str]:
    """The modules of the project that a module imports, with the packages that they lie in."""
    text, found = content(module).decode(), set()
    for source, names, whole in IMPORT.findall(text):
        for name in NAME.findall(names) or [""]:
            found.update(_files(f"{source or whole}.{name}"))
    return frozenset(found)


@cache
def content(module: str) -> bytes:
    """What the file of a module holds."""
    return (ROOT / module).read_bytes()


@cache
def _files(name: str) -> list[str]:
    """The files behind a dotted name: the packages on the way, and the module if it is one."""
    parts = name.strip(".").split(".")
    folders = ["/".join(parts[: end + 1]) for end in range(len(parts))]
    possible = [path for folder in folders for path in (f"{folder}/__init__.py", f"{folder}.py")]
    return [path for path in possible if _exists(path)]


@cache
def _exists(module: str) -> bool:
    return (ROOT / module).is_file()
