"""Which tests reach a function: a mutant in it meets these alone, those that take least first."""

import ast
import hashlib
import json
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import coverage
import pytest

CODE = ["recalib", "replication"]
ENOUGH = 60  # seconds of processor time, in which a mutant meets its tests


class Reach(NamedTuple):
    """What a test does.

    Attributes:
        seconds: of processor time.
        lines: of the project, by module, that it runs, or that fixtures run for it.
    """

    seconds: float
    lines: Mapping[str, list[int]]


class Watch:
    """A plugin of pytest that notes what tests reach."""

    def __init__(self):
        self.cover = coverage.Coverage(data_file=None, source=CODE)
        self.cover.start()
        self.fixtures, self.seconds, self.around = {}, {}, [""]

    def _within(self, context: str):
        self.around.append(context)
        self.cover.switch_context(context)
        yield
        self.around.pop()
        self.cover.switch_context(self.around[-1])

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item):
        start = time.process_time()
        yield from self._within(item.nodeid)
        self.seconds[item.nodeid] = time.process_time() - start
        self.fixtures[item.nodeid] = [f"fixture {name}" for name in item.fixturenames]

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        shared = fixturedef.scope != "function"
        yield from self._within(f"fixture {fixturedef.argname}" if shared else self.around[-1])

    def reached(self) -> dict[str, Reach]:
        """By test."""
        self.cover.stop()
        data, lines = self.cover.get_data(), {}
        for module in data.measured_files():
            name = str(Path(module).relative_to(Path.cwd()))
            for line, contexts in data.contexts_by_lineno(module).items():
                for context in contexts:
                    lines.setdefault(context, {}).setdefault(name, set()).add(line)
        reached = {}
        for test, fixtures in self.fixtures.items():
            own: dict[str, set] = {}
            for context in (test, *fixtures):
                for module, numbers in lines.get(context, {}).items():
                    own.setdefault(module, set()).update(numbers)
            reached[test] = Reach(self.seconds[test], {name: sorted(own[name]) for name in own})
        return reached


def files_of(tests: Iterable[str]) -> list[str]:
    """Test files among files and folders."""
    paths = [Path(test) for test in tests]
    files = [sorted(path.rglob("test_*.py")) if path.is_dir() else [path] for path in paths]
    return list(dict.fromkeys(str(path) for paths in files for path in paths))


def _cache_file(file: str, folder: Path) -> Path:
    """Where the reach of a file's tests is kept, for this code and this file."""
    code = [path.read_bytes() for name in CODE for path in sorted(Path(name).rglob("*.py"))]
    digest = hashlib.sha256(b"".join([*code, Path(file).read_bytes()])).hexdigest()[:12]
    return folder / "reach" / f"{file.replace('/', '.')}.{digest}.json"


def reach(tests: Iterable[str], folder: Path, run: Callable[..., None]) -> dict[str, Reach]:
    """What tests reach, from what is kept in a folder, or from a run of those files that are new.

    Args:
        run: runs test files in a process of its own, and there hands what they reach to a function.
    """
    files = files_of(tests)
    cache = {file: _cache_file(file, folder) for file in files}
    new = [file for file in files if not cache[file].exists()]

    def keep(reached: Mapping[str, Reach]) -> None:
        for file in new:
            own = {test: reached[test] for test in reached if test.split("::")[0] == file}
            cache[file].parent.mkdir(parents=True, exist_ok=True)
            cache[file].write_text(json.dumps(own), encoding="utf-8")

    if new:
        run(new, keep)
    tables = [json.loads(cache[file].read_text(encoding="utf-8")) for file in files]
    return {test: Reach(*row) for table in tables for test, row in table.items()}


def function_around(module: Path, line: int) -> range:
    """Lines of the body of the innermost function; of the module, where there is none.

    Only the first test that calls a cached function runs its lines: they count as the module's.
    """
    tree = ast.parse(module.read_bytes())
    kinds = ast.FunctionDef, ast.AsyncFunctionDef
    functions = [node for node in ast.walk(tree) if isinstance(node, kinds)]
    around = [
        node
        for node in functions
        if node.body[0].lineno <= line <= node.end_lineno and not _is_cached(node)
    ]
    if not around:
        return range(1, len(module.read_text("utf-8").splitlines()) + 1)
    innermost = max(around, key=lambda node: node.lineno)
    return range(innermost.body[0].lineno, innermost.end_lineno + 1)


def _is_cached(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return any(
        ast.unparse(name).startswith(("cache", "lru_cache")) for name in function.decorator_list
    )


def nearest(module: Path, line: int, reached: Mapping[str, Reach]) -> list[str]:
    """The tests that a mutant meets, in this order: those at its line first, then the fastest.

    As many as there is time for. Where none gets to its function, all are candidates.
    """
    body, name = {*function_around(module, line)}, str(module)
    inside = [test for test in reached if body & {*reached[test].lines.get(name, ())}]
    inside = inside or [*reached]  # coverage does not look into what Numba compiled
    inside.sort(key=lambda test: (line not in reached[test].lines.get(name, ()), reached[test][0]))
    chosen, seconds = [], 0.0
    for test in inside:
        if chosen and (seconds := seconds + reached[test].seconds) > ENOUGH:
            break
        chosen.append(test)
    return chosen
