"""Which modules of the project a script needs: editing one runs again what depends on it."""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = "recalib", "workflow"


@cache
def code(script: str) -> list[str]:
    """The script and every module that it imports, directly or not: paths below the project."""
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
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            parts = name.split(".")
            if parts[0] in PACKAGES:
                found += _files(parts)
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
