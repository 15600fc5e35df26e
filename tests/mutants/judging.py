"""Does a test notice? Each mutant meets its tests in a process forked from one that has imported.

To import what the project needs takes longer than most of its tests. What is forked has all of
that, but nothing of the project.
"""

import importlib
import os
import signal
import sys
import time
import traceback
from pathlib import Path

# What is imported before, in this order; nothing here imports the project.
BEFORE = [
    "numpy",
    "scipy.optimize",
    "scipy.stats",
    "scipy.linalg",
    "scipy.spatial.transform",
    "pinocchio",
    "numba",
    "sklearn.gaussian_process",
    "hypothesis.extra.numpy",
    "pandas",
    "pyarrow.parquet",
    "pydantic",
    "jinja2",
    "yaml",
    "pytest",
    "_pytest.assertion.rewrite",
    "matplotlib.figure",
]
OPTIONS = ["-x", "-q", "-n0", "--tb=line", "-p", "no:cacheprovider"]
OPTIONS += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # of what is imported already
PATIENCE = 600  # seconds; a loop that never ends is noticed, too
KILLED, SURVIVED, STILLBORN = "killed", "survived", "stillborn"

# By the part of the project that a mutant is in: the tests that it meets, the nearest first.
TESTS = {
    "recalib/identification": [
        "tests/identification",
        "tests/learners/test_peers.py",
        "tests/laboratory",
    ],
    "recalib/learners": [
        "tests/learners",
        "tests/test_learned.py",
        "tests/test_compiled.py",
        "tests/test_experiment.py",
        "tests/study/experiments/test_planted.py",
    ],
    "recalib/nominal": ["tests/nominal", "tests/damaged", "tests/test_compiled.py"],
    "recalib/damaged": ["tests/damaged", "tests/study/configuration/test_entries.py"],
    "recalib/study/statistics.py": [
        "tests/study/evidence/test_statistics.py",
        "tests/study/evidence/test_speedup.py",
    ],
    "recalib/study/evidence": [
        *(
            f"tests/study/evidence/test_{name}.py"
            for name in ("words", "tables", "contexts", "criteria")
        ),
        *(f"tests/study/evidence/test_{name}.py" for name in ("evidence", "speedup", "claims")),
        "tests/study/evidence/test_statistics.py",
        "tests/study/experiments/test_benchmark.py",
        "tests/study/evidence/test_report_texts.py",
        "tests/study/evidence/test_across.py",
        "tests/study/multiverse/test_multiverse.py",
        "tests/test_pages.py",
    ],
}
FOR_ALL = ["tests/test_architecture.py"]


def tests_of(module: str, folder: Path) -> list[str]:
    """The tests that a mutant of this module meets, those that are named for it first."""
    part = next(part for part in TESTS if module.startswith(part))
    own = folder.glob(f"tests/**/test_{Path(module).stem}.py")
    first = [str(path.relative_to(folder)) for path in own]
    return [*first, *(each for each in TESTS[part] if each not in first), *FOR_ALL]


def import_all() -> None:
    """Import what the tests will need."""
    for name in BEFORE:
        importlib.import_module(name)


def judge(folder: Path, tests: list[str], told: Path, kept: bool = False) -> str:
    """Run tests in a copy of the project, until one fails.

    Args:
        told: where to write what pytest says.
        kept: whether what is compiled is kept for the next: not of a mutant.

    Returns whether the mutant was killed, survived, or could not even be imported.
    """
    start, child = time.monotonic(), os.fork()
    if child == 0:
        try:
            _be_judged(folder, tests, told, kept)
        except BaseException:
            traceback.print_exc()
        os._exit(2)
    while not (ended := os.waitpid(child, os.WNOHANG))[0]:
        if time.monotonic() - start > PATIENCE:
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return KILLED
        time.sleep(0.05)
    code = os.waitstatus_to_exitcode(ended[1])
    # 2: pytest could not import it, for instance since an annotation makes no sense
    return {0: SURVIVED, 2: STILLBORN}.get(code, KILLED)


def _be_judged(folder: Path, tests: list[str], told: Path, kept: bool) -> None:
    import pytest
    from numba.core.caching import Cache

    os.setsid()
    os.chdir(folder)
    for name in [name for name in sys.modules if name.split(".")[0] == "tests"]:
        del sys.modules[name]  # those of the copy are meant
    os.environ["PYTHONPATH"] = str(folder)
    sys.path.insert(0, str(folder))
    if not kept:  # neither what Python compiled nor what Numba did
        sys.dont_write_bytecode = True
        Cache.save_overload = lambda *_: None
    with told.open("w", encoding="utf-8") as stream:
        for number in (1, 2):
            os.dup2(stream.fileno(), number)
        code = pytest.main([*OPTIONS, *tests])
        sys.stdout.flush()
    os._exit(int(code))
