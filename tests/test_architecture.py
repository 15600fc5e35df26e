import ast
import re
import subprocess
import sys

import pytest

from tests.conftest import ROOT, loaded_with

LIBRARY = "nominal", "damaged", "identification", "learners", "laboratory"
STUDY = "mapping", "experiments", "evidence", "multiverse", "plots", "recording"
# What the library draws with, in modules that nothing else of it imports, by what they need.
LOOKS = {
    "laboratory/page.py": {"jinja2"},
    "laboratory/watching.py": {"rerun"},
    "viewing.py": {"rerun"},
}
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
            heavy = {name.split(".")[0] for name in names} & FOR_STUDIES_ALONE
            assert heavy <= LOOKS.get(path.relative_to(ROOT / "recalib").as_posix(), set()), path


@pytest.mark.parametrize("package", sorted(set().union(*LOOKS.values())))
def test_what_draws_a_calibration_is_not_needed_to_make_one(package):
    """Where a package of the extra `laboratory` is absent, a file to look at is, and says so."""
    text = (
        f"import sys; sys.modules[{package!r}] = None\n"
        "from recalib.laboratory import calibrate, correct, propose, command_line\n"
        "from recalib.laboratory.files import optional_outputs\n"
        "written, missing = optional_outputs()\n"
        "print(len(written), missing)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", text], cwd=ROOT, text=True, capture_output=True, check=True
    )
    assert ran.stdout.startswith("1 ") and f"{package} is missing; pip install" in ran.stdout


def test_rerun_is_imported_by_the_recordings_alone():
    for path in (ROOT / "recalib").rglob("*.py"):
        uses = any(name.split(".")[0] == "rerun" for name in imported(path))
        allowed = path.parent.name == "recording" or path.name in ("viewing.py", "watching.py")
        assert not uses or allowed, path


def test_declaring_what_is_needed_loads_no_tables_and_draws_nothing():
    """The workflow does it whenever it starts."""
    declaring = "import recalib.study.evidence.pages, recalib.study.evidence.report"
    declaring += ", recalib.study.plots.registry"
    declaring += ", recalib.study.multiverse.universe, recalib.study.multiverse.design"
    heavy = {"pandas", "scipy", "matplotlib", "jinja2", "pinocchio", "numba"}
    assert loaded_with(declaring, heavy) == set()


def test_calibrating_an_arm_loads_no_tables_and_compiles_nothing():
    """Each takes a tenth of a second or more, and neither a calibration nor its page needs it."""
    heavy = {"pandas", "sklearn", "scipy.stats", "numba", "pydantic", "matplotlib"}
    calibrating = "import recalib.laboratory.files, recalib.laboratory.page, recalib.regression"
    assert loaded_with(calibrating, heavy) == set()


def test_what_no_type_can_say_is_rare_and_has_its_reason():
    ignored = [
        line
        for path in ROOT.glob("recalib/**/*.py*")
        if path.suffix in (".py", ".pyi")
        for line in path.read_text(encoding="utf-8").splitlines()
        if "type: ignore" in line
    ]
    assert len(ignored) <= 20
    for line in ignored:
        assert re.search(r"# type: ignore\[[a-z-]+\]  # \w{2,}", line), line


CHANGES = {"DamagedArm", "Finding"}  # what is gathered part by part


def decorators(node) -> list[str]:
    return [ast.unparse(each) for each in node.decorator_list if "dataclass" in ast.unparse(each)]


def test_what_is_made_once_cannot_be_changed_afterwards():
    """Values travel between parts, and stand in tables of what was computed of them."""
    changing = set()
    for path in (ROOT / "recalib").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            made = decorators(node) if isinstance(node, ast.ClassDef) else []
            if made and "frozen=True" not in made[0]:
                changing.add(node.name)
    assert changing == CHANGES
