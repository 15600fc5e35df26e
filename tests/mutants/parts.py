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


EXPERIMENTS = "tests/replication/training", "tests/replication/test_search.py", "tests/test_experiment.py"
EVIDENCE = tuple(
    f"tests/replication/judgement/test_{name}.py"
    for name in (
        *("words", "tables", "criteria", "evidence", "claims", "report_texts", "article"),
        *("across", "deviations", "factor", "findings", "outcome"),
        *("reference", "verdicts", "kept"),
    )
)
OF_STATISTICS = (
    *(f"tests/replication/judgement/test_{name}.py" for name in ("statistics", "speedup", "kept")),
    "tests/replication/test_hierarchy.py",
)
PARTS = {
    "experiments": Part(("replication/training", "recalib/loop/training.py"), EXPERIMENTS),
    "multiverse": Part(("replication/campaign",), ("tests/replication/campaign", *EXPERIMENTS[:2])),
    "mapping": Part(("replication/mapping",), ("tests/replication/mapping",)),
    "evidence": Part(("replication/judgement",), (*EVIDENCE, *OF_STATISTICS[1:2])),
    "statistics": Part(("replication/judgement",), OF_STATISTICS),
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
    "recording": Part(("replication/recording",), ("tests/replication/recording",)),
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
            *(f"replication/config/{name}.py" for name in ("units", "values")),
            *(f"replication/config/{name}.py" for name in ("damages", "universes")),
            "replication/scenarios",
            "replication/training/trainings.py",
        ),
        ("tests/replication/config", "tests/replication/test_assignments.py", *EXPERIMENTS[:1]),
    ),
}
TOO_LONG = (  # tests that take minutes: no mutant meets them
    "tests/replication/training/test_poses.py::"
    "test_no_test_pose_of_any_job_was_learned_from_or_searched_with",
    "tests/replication/training/test_planted.py::test_without_an_error_the_check_is_green",
    "tests/replication/test_hierarchy.py::test_intervals_hold_the_truth_as_often_as_they_say",
)
LEFT_OUT = {
    "replication/plots": "Figures are inspected by eye; their numbers come from `evidence`.",
    "replication/config": "The rest reads files; lists of mistakes test its messages.",
    "replication": "The rest names files and makes objects from descriptions.",
    "recalib": "The rest reads and writes files, and finds names.",
    "workflow": "It calls functions; whole runs test it.",
}


def modules(part: str) -> list[Path]:
    """Those of a part, here, that compute something."""
    found = []
    for path in map(Path, PARTS[part].modules):
        found += [path] if path.is_file() else sorted(path.rglob("*.py"))
    return [path for path in found if "def " in path.read_text("utf-8")]
