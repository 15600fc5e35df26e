import ast

import pytest

from tests.conftest import ROOT

LAYERS = "nominal", "damaged", "identification", "learners", "studies", "experiments", "evidence", "plots", "recording"


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


@pytest.mark.parametrize("layer", ["", *LAYERS])
def test_imports_point_one_way(layer):
    above = LAYERS[LAYERS.index(layer) + 1 :] if layer else LAYERS
    paths = sorted((ROOT / "recalib" / layer).glob("*.py"))
    assert paths
    for path in paths:
        assert not {name for name in imported(path) if name.startswith("recalib.") and name.split(".")[1] in above}, path


def test_every_package_has_its_layer():
    assert {path.parent.name for path in (ROOT / "recalib").glob("*/__init__.py")} == set(LAYERS)


def test_rerun_is_imported_by_the_recordings_alone():
    for path in (ROOT / "recalib").rglob("*.py"):
        uses = any(name.split(".")[0] == "rerun" for name in imported(path))
        assert not uses or path.parent.name == "recording", path
