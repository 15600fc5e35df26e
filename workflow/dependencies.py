"""Which code a script runs: editing a module runs again what depends on it, and nothing else.

A digest is handed to each job as a parameter. As inputs, the modules would be looked at by their
times, which a checkout changes, and so often that starting jobs took longer than many of them.
"""

import hashlib
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
# Read as text: to parse all modules takes longer than all else that happens at the start.
OURS = r"((?:recalib|workflow)[\w.]*)"
IMPORT = re.compile(rf"^ *(?:from {OURS} import (\([^)]*\)|.*)|import {OURS})", re.MULTILINE)


@cache
def code(script: str) -> str:
    """A digest of the script and of every module that it imports, directly or not."""
    digest = hashlib.sha256()
    for module in modules(script):
        digest.update(module.encode() + b"\0" + (ROOT / module).read_bytes())
    return digest.hexdigest()


@cache
def modules(script: str) -> list[str]:
    """The script and every module that it imports, as paths below the project."""
    needed, waiting = set(), [ROOT / "workflow" / "scripts" / script]
    while waiting:
        path = waiting.pop()
        if path not in needed:
            needed.add(path)
            waiting += imported(path)
    return sorted(path.relative_to(ROOT).as_posix() for path in needed)


@cache
def imported(path: Path) -> list[Path]:
    """The modules of the project that a module imports, with the packages that they lie in."""
    found: list[Path] = []
    for source, names, module in IMPORT.findall(path.read_text(encoding="utf-8")):
        for name in re.findall(r"(\w+)(?: as \w+)?", names) or [""]:
            found += _files([*(source or module).split("."), name])
    return found


def _files(parts: list[str]) -> list[Path]:
    """The files behind a dotted name: the packages on the way, and the module if it is one."""
    files, folder = [], ROOT
    for part in parts:
        folder = folder / part
        for path in (folder / "__init__.py", folder.with_suffix(".py")):
            if path.is_file():
                files.append(path)
    return files
