import ast
import subprocess
import sys

import pytest

from tests.conftest import ROOT

LIBRARY = "nominal", "damaged", "identification", "learners"
STUDY = "mapping", "experiments", "evidence", "multiverse", "plots", "recording"
FOR_STUDIES_ALONE = {
    "jinja2",
    "matplotlib",
    "pandas",
    "pyarrow",
    "pydantic",
    "rerun",
    "snakemake",
    "tqdm",
    "yaml",
}


def imported(path) -> set[str]:
    """The dotted names of all that a module imports."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}: a relative import hides where it points"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


@pytest.mark.parametrize(
    ("root", "layers"), [("recalib", LIBRARY), ("recalib.study", STUDY)], ids=["library", "study"]
)
def test_imports_point_one_way(root, layers):
    folder = ROOT.joinpath(*root.split("."))
    for index, layer in enumerate(layers):
        above = tuple(f"{root}.{each}." for each in layers[index + 1 :])
        paths = sorted((folder / layer).glob("*.py"))
        assert paths
        for path in paths:
            assert not [name for name in imported(path) if name.startswith(above)], path


def test_every_package_has_its_layer():
    packages = {path.parent.name for path in (ROOT / "recalib").glob("*/__init__.py")}
    assert packages == {*LIBRARY, "study"}
    assert {*STUDY} <= {
        path.parent.name for path in (ROOT / "recalib" / "study").glob("*/__init__.py")
    }


def test_the_library_knows_of_no_study_and_needs_none_of_its_packages():
    for path in (ROOT / "recalib").rglob("*.py"):
        if "study" not in path.relative_to(ROOT).parts:
            names = imported(path)
            assert not [name for name in names if name.startswith("recalib.study")], path
            assert not {name.split(".")[0] for name in names} & FOR_STUDIES_ALONE, path


def test_rerun_is_imported_by_the_recordings_alone():
    for path in (ROOT / "recalib").rglob("*.py"):
        uses = any(name.split(".")[0] == "rerun" for name in imported(path))
        assert not uses or path.parent.name == "recording", path


def test_declaring_what_is_needed_loads_no_tables_and_draws_nothing():
    """The workflow does it whenever it starts."""
    declaring = "recalib.study.evidence.pages, recalib.study.evidence.report"
    declaring += ", recalib.study.plots.registry, recalib.study.evidence.coverage"
    declaring += ", recalib.study.multiverse.universe, recalib.study.multiverse.design"
    heavy = "{'pandas', 'scipy', 'matplotlib', 'jinja2', 'pinocchio', 'sklearn'}"
    text = f"import sys, {declaring}; print(*({heavy} & sys.modules.keys()))"
    ran = subprocess.run(
        [sys.executable, "-c", text], cwd=ROOT, text=True, capture_output=True, check=True
    )
    assert ran.stdout.split() == []
