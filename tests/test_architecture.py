import ast
import re
import subprocess
import sys
import tomllib
from functools import cache

import pytest

from tests.conftest import ROOT, loaded_with

# Packages and loose modules, from the ground up: each imports those before it alone.
LIBRARY = """
    spelling errors arrays numerics files nominal loop damaged identification vision learners
    station laboratory __main__
""".split()  # noqa: SIM905
STUDY = """
    inference configuration scenarios plan mapping experiments evidence checks multiverse plots
    recording studies
""".split()  # noqa: SIM905
IDENTIFICATION = """
    model closed_forms hand_eye_model hand_eye initial_estimate unseen estimation parameters
    calibration consensus design checks held_out validation arm_as_right
""".split()  # noqa: SIM905
LABORATORY = """
    tables urdf places data_set reaching correction plausibility results viewer report calibrate
    pictures propose live hand_eye options commands command_line
""".split()  # noqa: SIM905
EVIDENCE = """
    effects checks summary results verdicts speedup benchmark needs factor claims reference
    factor_in_setups pages
""".split()  # noqa: SIM905
# What the library draws with, in modules that nothing else of it imports, by what they need.
LOOKS = {
    "laboratory/report/drawings.py": {"matplotlib"},
    "laboratory/report/recording.py": {"rerun"},
    "laboratory/viewer/scene.py": {"rerun"},
}
PROGRAM = {"laboratory/viewer/process.py": {"rerun_cli"}}  # of the viewer, which comes with rerun
SHAPES = {"laboratory/live/clearance.py": {"coal"}}  # it comes with pin
# What needs the extra `vision`: modules that nothing imports at once but each other.
PICTURES = {
    "laboratory/pictures/observe.py": {"cv2"},
    "laboratory/pictures/observed.py": {"cv2"},
    "laboratory/pictures/page_of_pictures.py": {"cv2", "matplotlib"},
    "vision/boards.py": {"cv2"},
    "vision/detection.py": {"PIL", "cv2"},
    "vision/patterns.py": {"cv2"},
    "vision/printing.py": {"matplotlib"},
    "vision/views.py": {"cv2"},
}
# What the library needs beside Python, by the name under which it is installed.
NEEDED = {
    "example-robot-data": "example_robot_data",
    "jinja2": "jinja2",
    "lazy-loader": "lazy_loader",
    "numba": "numba",
    "numpy": "numpy",
    "pin": "pinocchio",
    "pyyaml": "yaml",
    "scipy": "scipy",
}
# Each takes a tenth of a second or more to import: who waits for it needs it.
HEAVY = {
    "cv2",
    "jinja2",
    "matplotlib",
    "mujoco",
    "numba",
    "pandas",
    "pinocchio",
    "rerun",
    "scipy.optimize",
    "scipy.spatial",
    "scipy.stats",
    "sklearn",
    "snakemake",
}


@cache
def imported(path, at_once: bool = False) -> set[str]:
    """The dotted names of all that a module imports; or of what it imports when it is."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    names = set()
    for node in tree.body if at_once else ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}: a relative import hides where it points"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def files_of(name: str) -> set[str]:
    """The files of the project that an import of a dotted name goes through."""
    parts = name.split(".")
    stems = ["/".join(parts[: count + 1]) for count in range(len(parts))]
    paths = {f"{stem}{end}" for stem in stems for end in (".py", "/__init__.py")}
    return {path for path in paths if (ROOT / path).is_file()}


@pytest.mark.parametrize("name", ["recalib", "recalib.laboratory.command_line"])
def test_what_is_imported_first_waits_for_nothing(name):
    assert loaded_with(f"import {name}", {"numpy", *HEAVY}) == set()


@pytest.mark.parametrize(
    ("root", "order"),
    [
        ("recalib", LIBRARY),
        ("recalib.identification", IDENTIFICATION),
        ("recalib.laboratory", LABORATORY),
        ("recalib.study", STUDY),
        ("recalib.study.evidence", EVIDENCE),
    ],
)
def test_imports_point_one_way(root, order):
    folder, seen = ROOT.joinpath(*root.split(".")), set()
    for path in folder.rglob("*.py"):
        unit = path.relative_to(folder).parts[0].removesuffix(".py")
        if unit in ("__init__", "study"):
            continue
        seen.add(unit)
        above = tuple(f"{root}.{other}." for other in order[order.index(unit) + 1 :])
        assert not [name for name in imported(path) if f"{name}.".startswith(above)], path
    assert seen == {*order}


def test_the_library_knows_of_no_study_and_needs_what_it_declares():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert [its.partition(">=")[0] for its in project["dependencies"]] == [*NEEDED]
    for path in (ROOT / "recalib").rglob("*.py"):
        if "study" not in path.relative_to(ROOT).parts:
            names = imported(path)
            assert not [name for name in names if name.startswith("recalib.study")], path
            tops = {name.split(".")[0] for name in names} - sys.stdlib_module_names - {"recalib"}
            looks = (LOOKS | PROGRAM | PICTURES | SHAPES).get(
                path.relative_to(ROOT / "recalib").as_posix(), set()
            )
            assert tops <= {*NEEDED.values()} | looks, path


def test_a_calibration_needs_no_optional_package():
    """Who lacks one for a page, a recording or pictures is told so, before any work."""
    text = (
        "import sys; sys.modules |= dict.fromkeys(('matplotlib', 'rerun', 'cv2', 'mujoco'))\n"
        "from recalib.laboratory import calibrate, propose\n"
        "from recalib.laboratory.report import folder\n"
        "from recalib.laboratory.command_line import main\n"
        "sys.exit(main(['calibrate', 'arm.urdf', 'm.csv', '--out=/nowhere/new']))"
    )
    ran = subprocess.run([sys.executable, "-c", text], cwd=ROOT, text=True, capture_output=True)
    assert "matplotlib is missing; try: pip install 'recalib[laboratory" in ran.stderr


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
    return [ast.unparse(its) for its in node.decorator_list if "dataclass" in ast.unparse(its)]


def test_what_is_made_once_cannot_be_changed_afterwards():
    """Values travel between parts, and stand in tables of what was computed of them."""
    changing = set()
    for path in (ROOT / "recalib").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            made = decorators(node) if isinstance(node, ast.ClassDef) else []
            if made and "frozen=True" not in made[0]:
                changing.add(node.name)
    assert changing == CHANGES


def test_a_class_has_a_name_of_its_own():
    names = [
        node.name
        for folder in ("recalib", "workflow")
        for path in (ROOT / folder).rglob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    ]
    assert len(names) == len({*names})
