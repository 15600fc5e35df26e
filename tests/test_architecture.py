import ast

import pytest

from tests.conftest import ROOT

LAYERS = "nominal", "damaged", "identification", "learners", "studies", "experiments", "evidence", "plots", "recording"


def imported(path) -> set[str]:
    """The packages of recalib that a module imports from; "" for what all of it shares."""
    modules = [node.module.split(".") for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]
    return {name[1] if len(name) > 1 and name[1] in LAYERS else "" for name in modules if name[0] == "recalib"}


@pytest.mark.parametrize("layer", ["", *LAYERS])
def test_imports_point_one_way(layer):
    allowed = {"", *LAYERS[: LAYERS.index(layer) + 1]} if layer else {""}
    paths = sorted((ROOT / "recalib" / layer).glob("*.py"))
    assert paths
    for path in paths:
        assert imported(path) <= allowed, path


def test_every_package_has_its_layer():
    packages = {path.parent.name for path in (ROOT / "recalib").glob("*/__init__.py")}
    assert packages == set(LAYERS)


def test_rerun_is_imported_by_the_recordings_alone():
    for path in (ROOT / "recalib").rglob("*.py"):
        assert ("import rerun" in path.read_text()) <= (path.parent.name == "recording"), path
