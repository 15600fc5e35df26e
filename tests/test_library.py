"""The library by itself: its public names, its examples, and its wheel where nothing else is."""

import ast
import importlib
import importlib.metadata
import inspect
import re
import runpy
import shutil
import subprocess
import sys
import tarfile
import venv
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import recalib
from tests.conftest import ROOT, loaded_with

ALONE = "ur10", "notebook"  # the robot of the examples, and tests/test_notebook.py
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*.py") if path.stem not in ALONE)
FOR_STUDIES = "matplotlib", "pandas", "pydantic", "rerun", "snakemake", "yaml"


@pytest.mark.parametrize("name", recalib.__all__)
def test_a_public_name_has_a_home_and_says_what_it_is(name):
    value = getattr(recalib, name)
    assert name in dir(recalib)
    if name.isupper():
        return
    assert value.__module__.startswith("recalib.")
    assert len(inspect.getdoc(value)) > 40


def test_an_unknown_name_is_no_attribute():
    with pytest.raises(ImportError, match="cannot import name 'trian'"):
        from recalib import trian  # noqa: F401


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda its: its.stem)
def test_an_example_needs_the_public_names_alone(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules = {alias.name for alias in node.names}
        else:
            modules = {node.module} if isinstance(node, ast.ImportFrom) else set()
        assert not {module for module in modules if module.startswith("recalib.")}
        if modules == {"recalib"} and isinstance(node, ast.ImportFrom):
            assert {alias.name for alias in node.names} <= {*recalib.__all__}
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "recalib":
            assert node.attr in recalib.__all__


MISUSE = """
import recalib
from recalib.damaged.fleet import Fleet

def robots(one: recalib.Plant, several: Fleet, own: recalib.ExternalRobot) -> None:
    taken: list[recalib.Commandable] = [one, several, own]

recalib.Controller(3, nonsense=4)
recalib.load_robott("ur10_robot.urdf")
"""


@pytest.mark.slow
def test_a_type_checker_knows_the_public_names_and_finds_no_fault_with_the_examples(tmp_path):
    pytest.importorskip("mypy", reason="needs mypy, of the extra dev")
    (tmp_path / "misuse.py").write_text(MISUSE)
    ran = subprocess.run(
        [sys.executable, "-m", "mypy", "examples", tmp_path / "misuse.py"],
        cwd=ROOT,
        text=True,
        capture_output=True,
    )
    # not the whole path: of the same text, mypy's cache still knows the one of the last run
    faults = re.findall(r"(\w+)\.py:(\d+): error:", ran.stdout)
    assert faults == [("misuse", "8"), ("misuse", "8"), ("misuse", "9")], ran.stdout
    assert "nonsense" in ran.stdout and "load_robott" in ran.stdout


def test_the_packages_come_with_the_names_that_need_them():
    assert (
        loaded_with("import recalib", {"numpy", "scipy", "pinocchio", "numba", "sklearn"}) == set()
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_ends_with_small_errors(name, monkeypatch, capsys):
    path = ROOT / "examples" / f"{name}.py"
    assert len(path.read_text().splitlines()) <= 30
    monkeypatch.syspath_prepend(path.parent)
    monkeypatch.setattr("matplotlib.pyplot.show", lambda: None)
    runpy.run_path(str(path))
    told = capsys.readouterr().out
    errors = [float(number) for number in re.findall(r"([\d.]+) (?:mm|cm)", told)]
    assert 0 <= errors[-1] < 0.1 * errors[0]
    if name == "save_and_load":
        assert "is of another robot: its home differs by up to 0.1" in told


def closure(names) -> set[str]:
    """These distributions and all that they need, extras left out."""
    needed, waiting = set(), {canonicalize_name(name) for name in names}
    while waiting:
        name = waiting.pop()
        needed.add(name)
        for text in importlib.metadata.requires(name) or []:
            requirement = Requirement(text)
            if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
                waiting |= {canonicalize_name(requirement.name)} - needed
    return needed


def link(names, site: Path) -> None:
    """Put what these distributions installed here into another environment, by links."""
    for each in map(importlib.metadata.distribution, names):
        for top in {file.parts[0] for file in each.files} - {"..", "__pycache__"}:
            if not (site / top).exists():  # Pinocchio's distributions share a folder
                (site / top).symlink_to(each.locate_file(top))


@pytest.fixture(scope="module")
def committed() -> set[str]:
    """The paths of all files that git holds, or would."""
    listing = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("this copy is no git repository")
    return {path for path in listed.stdout.splitlines() if (ROOT / path).is_file()}


@pytest.fixture(scope="module")
def released(committed, tmp_path_factory) -> Path:
    """A folder with the sources that are released, and the wheel that is made of them."""
    folder = tmp_path_factory.mktemp("released")
    source = folder / "source"
    for path in committed:
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, source / path)
    build = [sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, source]
    subprocess.run(build, cwd=folder, check=True)
    return folder


@pytest.mark.slow
def test_the_sources_that_are_released_are_what_git_holds(released, committed):
    (path,) = released.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        files = {file.name.partition("/")[2] for file in archive if file.isfile()}
    built = {file for file in files if file.startswith("recalib.egg-info/")}
    assert files - built - {"PKG-INFO", "setup.cfg"} == committed


@pytest.fixture(scope="module")
def empty(released, tmp_path_factory) -> Path:
    """The Python of an environment with the wheel and what it declares to need, nothing else."""
    environment = tmp_path_factory.mktemp("environment")
    venv.create(environment, symlinks=True)
    python = environment / "bin" / "python"
    (wheel,) = released.glob("*.whl")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    alone = ["--no-index", "--no-deps"]
    subprocess.run([*pip, "--python", python, "install", *alone, wheel], check=True)
    (site,) = environment.glob("lib/python*/site-packages")
    (installed,) = importlib.metadata.distributions(path=[str(site)])
    needed = map(Requirement, installed.requires)
    declared = [
        each.name for each in needed if not each.marker or each.marker.evaluate({"extra": ""})
    ]
    link(closure(declared), site)
    return python


@pytest.mark.slow
def test_the_wheel_works_where_nothing_of_the_studies_is(empty, tmp_path):
    code = f"""
import importlib.util
import recalib
assert "environment" in recalib.__file__, recalib.__file__
assert [name for name in {FOR_STUDIES} if importlib.util.find_spec(name)] == []
for name in recalib.__all__:
    getattr(recalib, name)
"""
    subprocess.run([empty, "-I", "-c", code], cwd=tmp_path, check=True)
    example = shutil.copytree(ROOT / "examples", tmp_path / "examples") / "save_and_load.py"
    told = subprocess.run(
        [empty, example], cwd=tmp_path, check=True, capture_output=True, text=True
    ).stdout
    assert "commanded corrected: 0.0000" in told
