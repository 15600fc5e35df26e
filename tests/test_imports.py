"""Imports point one way (`[tool.importlinter]` in pyproject.toml); those that wait are light."""

import ast
import tomllib
from collections.abc import Iterator

import pytest
from importlinter.cli import lint_imports

from replication.running import LAYERS
from tests.conftest import ROOT, loaded_with

# Each takes a tenth of a second or more to import: who waits for it needs it.
HEAVY = {"cv2", "jinja2", "matplotlib", "mujoco", "numba", "numpy", "pandas", "pinocchio", "rerun"}
HEAVY |= {"scipy.optimize", "scipy.spatial", "scipy.stats", "sklearn", "snakemake"}


def test_imports_point_one_way(monkeypatch):
    monkeypatch.chdir(ROOT)
    assert lint_imports(no_cache=True) == 0


def test_a_job_runs_again_if_the_code_below_it_changes():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = {
        contract["name"]: contract for contract in project["tool"]["importlinter"]["contracts"]
    }
    order = contracts["The replication, from pages down to the study"]["layers"]
    assert [*LAYERS] == ["recalib", *(f"replication.{layer}" for layer in reversed(order[1:]))]


@pytest.mark.parametrize("name", ["recalib", "recalib.laboratory.command_line"])
def test_what_is_imported_first_waits_for_nothing(name):
    assert loaded_with(f"import {name}", HEAVY) == set()


HARNESSES = {"bars", "faults", "mutants", "peers", "slurm"}


def public() -> Iterator[bool]:
    """Of each name that tests import of the project, whether a package exports it."""
    for path in (ROOT / "tests").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            module = (isinstance(node, ast.ImportFrom) and node.module) or ""
            if module.startswith(("recalib", "replication")) and not HARNESSES & {*path.parts}:
                home = ROOT.joinpath(*module.split("."))
                for alias in node.names:
                    inner = (home / f"{alias.name}.py").exists() or (home / alias.name).is_dir()
                    yield home.is_dir() and not inner


def test_tests_see_what_callers_see():
    found = [*public()]
    assert sum(found) >= 0.75 * len(found)
