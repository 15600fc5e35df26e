"""What is judged, by which tests, and what is not, with the reason."""

from pathlib import Path
from typing import NamedTuple


class Part(NamedTuple):
    """A package, or modules that belong together.

    Attributes:
        modules: files and folders.
        tests: the nearest ones: files and folders.
    """

    modules: tuple[str, ...]
    tests: tuple[str, ...]


EXPERIMENTS = "tests/study/experiments", "tests/study/test_search.py", "tests/test_experiment.py"
EVIDENCE = tuple(
    f"tests/study/evidence/test_{name}.py"
    for name in (
        *("words", "tables", "criteria", "evidence", "claims", "report_texts", "article"),
        *("across", "deviations", "factor", "findings", "outcome"),
        *("reference", "verdicts", "kept"),
    )
)
OF_STATISTICS = (
    *(f"tests/study/evidence/test_{name}.py" for name in ("statistics", "speedup", "kept")),
    "tests/study/test_hierarchy.py",
)
PARTS = {
    "experiments": Part(("recalib/study/experiments", "recalib/loop/training.py"), EXPERIMENTS),
    "multiverse": Part(("recalib/study/multiverse",), ("tests/study/multiverse", *EXPERIMENTS[:2])),
    "mapping": Part(("recalib/study/mapping",), ("tests/study/mapping",)),
    "evidence": Part(("recalib/study/evidence",), (*EVIDENCE, *OF_STATISTICS[1:2])),
    "statistics": Part(("recalib/study/inference",), OF_STATISTICS),
    "learners": Part(
        ("recalib/learners",),
        ("tests/learners", "tests/test_learned.py", *EXPERIMENTS[2:]),
    ),
    "identification": Part(
        ("recalib/identification", "recalib/numerics"),
        ("tests/identification", "tests/test_regression.py"),
    ),
    "laboratory": Part(
        ("recalib/laboratory",), ("tests/laboratory", "tests/vision", "tests/station")
    ),
    "station": Part(("recalib/station",), ("tests/station", "tests/vision/test_stations.py")),
    "vision": Part(("recalib/vision",), ("tests/vision",)),
    "recording": Part(("recalib/study/recording",), ("tests/study/recording",)),
    "nominal": Part(
        ("recalib/nominal",),
        (
            *("tests/nominal", "tests/damaged", "tests/test_meshes.py"),
            "tests/laboratory/test_mistakes_on_the_command_line.py",
        ),
    ),
    "damaged": Part(("recalib/damaged",), ("tests/damaged", *EXPERIMENTS[2:])),
    "configuration": Part(
        (
            *(f"recalib/study/configuration/{name}.py" for name in ("units", "values")),
            *(f"recalib/study/configuration/{name}.py" for name in ("damages", "universes")),
            "recalib/study/scenarios",
            "recalib/study/plan/trainings.py",
        ),
        ("tests/study/configuration", "tests/study/test_assignments.py", *EXPERIMENTS[:1]),
    ),
}
TOO_LONG = (  # tests that take minutes: no mutant meets them
    "tests/study/experiments/test_poses.py::"
    "test_no_test_pose_of_any_job_was_learned_from_or_searched_with",
    "tests/study/experiments/test_planted.py::test_without_an_error_the_check_is_green",
    "tests/study/test_hierarchy.py::test_intervals_hold_the_truth_as_often_as_they_say",
)
LEFT_OUT = {
    "recalib/study/plots": "Figures are inspected by eye; their numbers come from `evidence`.",
    "recalib/study/configuration": "The rest reads files; lists of mistakes test its messages.",
    "recalib/study": "The rest names files and makes objects from descriptions.",
    "recalib": "The rest reads and writes files, and finds names.",
    "workflow": "It calls functions; whole runs test it.",
}


def modules(part: str) -> list[Path]:
    """Those of a part, here, that compute something."""
    found = []
    for path in map(Path, PARTS[part].modules):
        found += [path] if path.is_file() else sorted(path.rglob("*.py"))
    return [path for path in found if "def " in path.read_text("utf-8")]
