"""Automatic recalibration of damaged robots: Ruiz de Angulo and Torras (1996), and what came since.

The library knows of arms, damages and learners; `replication` replicates the paper with it. What
a user needs can be imported from here; the examples show how it fits together.
"""

from functools import cache
from importlib import import_module
from typing import Any

__version__ = "2.0.0"


@cache
def _homes() -> dict[str, str]:
    """The module of each public name, from the stub that type checkers and editors read.

    A name is imported when it is asked for: Pinocchio, Numba and SciPy take a second, and nobody
    needs all of them.
    """
    import ast
    from pathlib import Path

    tree = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return {alias.name: node.module or "" for node in imports for alias in node.names}


def __getattr__(name: str) -> Any:
    if name == "__all__":
        return sorted(_homes())
    if name not in _homes():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_homes()[name]), name)


def __dir__() -> list[str]:
    return [*globals(), *_homes()]
