"""What is judged, by which tests, and what is not, with the reason."""

from pathlib import Path
from typing import NamedTuple


class Part(NamedTuple):
    """A package, or modules that belong together.

    Attributes:
        modules: files and folders.
        tests: the nearest ones: files and folders.
        others: files and folders below `modules` that belong to another part.
    """

    modules: tuple[str, ...]
    tests: tuple[str, ...]
    others: tuple[str, ...] = ()


# what moves an arm, or says where it should go
MOVING = (
    "recalib/station",
    *(f"recalib/laboratory/{name}" for name in ("live", "correction.py", "reaching.py")),
)
EXPERIMENTS = "tests/replication/training", "tests/test_experiment.py"
# what the jobs compute of small studies
KEPT = "tests/replication/test_kept.py", "tests/replication/campaign/test_searches.py"
PARTS = {
    "experiments": Part(
        ("replication/training", "recalib/loop/training.py"), (*EXPERIMENTS, *KEPT)
    ),
    "campaign": Part(("replication/campaign",), ("tests/replication/campaign", EXPERIMENTS[0])),
    "scenarios": Part(("replication/scenarios",), ("tests/replication/scenarios", *KEPT[:1])),
    "mapping": Part(
        ("replication/mapping",),
        ("tests/replication/mapping", f"{EXPERIMENTS[0]}/test_poses.py", *KEPT[:1]),
    ),
    "judgement": Part(
        ("replication/judgement",),
        ("tests/replication/judgement",),
    ),
    "learners": Part(
        ("recalib/learners",),
        ("tests/learners", "tests/test_learned.py", "tests/test_library.py", EXPERIMENTS[1]),
    ),
    "identification": Part(
        ("recalib/identification", "recalib/numerics"),
        (
            *("tests/identification", "tests/test_regression.py"),
            *(f"tests/vision/test_{name}.py" for name in ("hand_eye", "several_cameras")),
        ),
    ),
    "moving": Part(
        MOVING, ("tests/station", "tests/laboratory", "tests/vision/test_live_by_pixels.py")
    ),
    "laboratory": Part(
        ("recalib/laboratory",), ("tests/laboratory", "tests/vision", "tests/station"), MOVING
    ),
    "vision": Part(("recalib/vision",), ("tests/vision",)),
    "recording": Part(("replication/recording",), ("tests/replication/recording", *KEPT[:1])),
    "nominal": Part(
        ("recalib/nominal",),
        (
            *("tests/nominal", "tests/damaged", "tests/test_meshes.py"),
            "tests/laboratory/test_mistakes_on_the_command_line.py",
            "tests/test_library.py",
        ),
    ),
    "damaged": Part(
        ("recalib/damaged",),
        (
            *("tests/damaged", EXPERIMENTS[1], "tests/test_library.py"),
            *(f"tests/replication/config/test_{name}.py" for name in ("entries", "config")),
        ),
    ),
    "configuration": Part(
        tuple(f"replication/config/{name}.py" for name in ("units", "values", "damages")),
        (
            *("tests/replication/config", "tests/faults/test_settings.py"),
            "tests/replication/scenarios/test_resolving.py",
        ),
    ),
}
# Of what moves an arm or states an error more mutants are judged.
THOROUGH, TIMES = ("identification", "moving", "laboratory"), 5
# Not judged: replication/plots, since figures are inspected by eye and their numbers come from
# judgement; the rest of replication and recalib, which reads and writes files and finds names, so
# that lists of mistakes test its messages; workflow, which calls functions: whole runs test it.


def modules(part: str) -> list[Path]:
    """Those of a part, here, that compute something."""
    within, _, others = PARTS[part]
    paths = [path for path in _files(within) if path not in _files(others)]
    return [path for path in paths if "def " in path.read_text("utf-8")]


def _files(names: tuple[str, ...]) -> list[Path]:
    """The files of Python among these files, and in these folders."""
    return [
        path
        for name in map(Path, names)
        for path in ([name] if name.is_file() else sorted(name.rglob("*.py")))
    ]
