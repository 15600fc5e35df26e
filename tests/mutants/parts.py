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


EXPERIMENTS = "tests/replication/training", "tests/test_experiment.py"
PARTS = {
    "experiments": Part(("replication/training", "recalib/loop/training.py"), EXPERIMENTS),
    "campaign": Part(("replication/campaign",), ("tests/replication/campaign", EXPERIMENTS[0])),
    "scenarios": Part(("replication/scenarios",), ("tests/replication/scenarios",)),
    "mapping": Part(("replication/mapping",), ("tests/replication/mapping",)),
    "judgement": Part(
        ("replication/judgement",),
        ("tests/replication/judgement", "tests/replication/campaign/test_table_to_verdict.py"),
    ),
    "learners": Part(
        ("recalib/learners",),
        ("tests/learners", "tests/test_learned.py", EXPERIMENTS[1]),
    ),
    "identification": Part(
        ("recalib/identification", "recalib/numerics"),
        ("tests/identification", "tests/test_regression.py"),
    ),
    "laboratory": Part(
        ("recalib/laboratory",), ("tests/laboratory", "tests/vision", "tests/station")
    ),
    "station": Part(("recalib/station",), ("tests/station",)),
    "vision": Part(("recalib/vision",), ("tests/vision",)),
    "recording": Part(("replication/recording",), ("tests/replication/recording",)),
    "nominal": Part(
        ("recalib/nominal",),
        (
            *("tests/nominal", "tests/damaged", "tests/test_meshes.py"),
            "tests/laboratory/test_mistakes_on_the_command_line.py",
        ),
    ),
    "damaged": Part(("recalib/damaged",), ("tests/damaged", EXPERIMENTS[1])),
    "configuration": Part(
        tuple(f"replication/config/{name}.py" for name in ("units", "values", "damages")),
        ("tests/replication/config", "tests/faults/test_settings.py"),
    ),
}
TOO_LONG = (  # tests that take minutes: no mutant meets them
    "tests/replication/training/test_poses.py::"
    "test_no_test_pose_of_any_job_was_learned_from_or_searched_with",
    "tests/replication/campaign/test_planted.py::test_what_was_planted_is_found",
)
# Not judged: replication/plots, since figures are inspected by eye and their numbers come from
# judgement; the rest of replication and recalib, which reads and writes files and finds names, so
# that lists of mistakes test its messages; workflow, which calls functions: whole runs test it.


def modules(part: str) -> list[Path]:
    """Those of a part, here, that compute something."""
    paths = []
    for path in map(Path, PARTS[part].modules):
        paths += [path] if path.is_file() else sorted(path.rglob("*.py"))
    return [path for path in paths if "def " in path.read_text("utf-8")]
