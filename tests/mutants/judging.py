"""Does a test notice? Each mutant meets its tests in a process forked from one that has imported.

To import what the project needs takes longer than most of its tests. What is forked has all of
that, but nothing of the project.
"""

import importlib
import os
import resource
import signal
import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from tests.mutants.nearest import Reach, Watch

# What is imported before, in this order; nothing here imports the project.
BEFORE = [
    "numpy",
    "scipy.optimize",
    "scipy.stats",
    "scipy.linalg",
    "scipy.spatial.transform",
    "pinocchio",
    "numba",
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
OPTIONS += ["-m", "not slow"]
PATIENCE = 60  # seconds of processor time beyond what the tests take; an endless loop is noticed
NONE = 5  # pytest's exit code if a file has only slow tests
KILLED, SURVIVED, STILLBORN = "killed", "survived", "stillborn"
Keep = Callable[[Mapping[str, Reach]], None]


def import_all() -> None:
    """Import what the tests will need."""
    for name in BEFORE:
        importlib.import_module(name)


def judge(
    folder: Path, tests: list[str], log: Path, seconds: float = np.inf, keep: Keep | None = None
) -> str:
    """Run tests in a copy of the project, until one fails.

    Args:
        log: where to write the output of pytest.
        seconds: of processor time, after which the tests are killed.
        keep: gets what the tests reach. What is compiled is kept for the next then, too: not of a
            mutant.

    Returns whether the mutant was killed, survived, or could not even be imported.
    """
    child = os.fork()
    if child == 0:
        try:
            if np.isfinite(seconds):
                most = int(seconds + PATIENCE)
                resource.setrlimit(resource.RLIMIT_CPU, (most, most))
                signal.alarm(5 * most)  # one that waits takes no processor time
            _run_tests(folder, tests, log, keep)
        except BaseException:
            traceback.print_exc()
        os._exit(2)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    # 2: pytest could not import it, for instance since an annotation makes no sense
    return {0: SURVIVED, 2: STILLBORN, NONE: SURVIVED}.get(code, KILLED)


def _run_tests(folder: Path, tests: list[str], log: Path, keep: Keep | None) -> None:
    import pytest
    from numba.core.caching import Cache

    os.chdir(folder)
    for name in [name for name in sys.modules if name.split(".")[0] == "tests"]:
        del sys.modules[name]  # those of the copy are meant
    os.environ["PYTHONPATH"] = str(folder)
    sys.path.insert(0, str(folder))
    if keep is None:  # neither what Python compiled nor what Numba did
        sys.dont_write_bytecode = True
        Cache.save_overload = lambda *_: None
    with log.open("w", encoding="utf-8") as stream:
        for number in (1, 2):
            os.dup2(stream.fileno(), number)
        watch = Watch() if keep else None
        code = pytest.main([*OPTIONS, *tests], plugins=[watch] if watch else [])
        if watch and code in (0, NONE):
            keep(watch.reached())
        sys.stdout.flush()
    os._exit(int(code))
