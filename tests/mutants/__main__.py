"""Small errors that nobody chose: how many of them do the tests notice?

cosmic-ray makes them, one at a time, in a copy of the project. They are taken in an order drawn by
a fixed seed, so that a sample can be made larger. What was found is kept in results/mutants and
said on docs/mutants.md. A change of the code begins anew; after a change of tests, `--again` has
them meet the survivors.

    python -m tests.mutants --count 300
"""

import argparse
import hashlib
import os
import random
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from cosmic_ray.commands import init
from cosmic_ray.mutating import apply_mutation
from cosmic_ray.plugins import get_operator
from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import MutationSpec, TestOutcome, WorkerOutcome, WorkItem, WorkResult
from tqdm import tqdm

from tests.mutants.judging import KILLED, STILLBORN, SURVIVED, TESTS, import_all, judge, tests_of
from tests.mutants.page import difference, write_page

ROOT, SEED = Path(__file__).parents[2], 1996
KEPT = ROOT / "results" / "mutants"


def modules(part: str) -> list[Path]:
    """Those of a part of the project, here, that compute something."""
    path = Path(part)
    found = [path] if path.is_file() else sorted(path.rglob("*.py"))
    return [each for each in found if "def " in each.read_text("utf-8")]


def session(part: str) -> Path:
    """The file of a part's mutants and of what was found, made where the part has changed."""
    digest = hashlib.sha256(b"".join(each.read_bytes() for each in modules(part)))
    path = KEPT / f"{part.replace('/', '.')}.{digest.hexdigest()[:12]}.sqlite"
    if not path.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        for older in KEPT.glob(f"{part.replace('/', '.')}.*.sqlite"):
            older.unlink()
        with use_db(path) as mutants:
            init(modules(part), mutants, {})
    return path


def drawn(part: str, mutants: WorkDB) -> list[WorkItem]:
    """All mutants of a part, in the order in which they are to be judged."""
    items = sorted(mutants.work_items, key=lambda item: repr(item.mutations))
    random.Random(f"{SEED} {part}").shuffle(items)
    return items


def copy_of_the_project(folder: Path) -> None:
    """What git knows or would know of, with what was compiled of it."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, names.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def try_out(mutation: MutationSpec, folder: Path) -> WorkResult:
    """Whether the tests notice a mutant in a copy of the project, which is left as it was."""
    module = folder / mutation.module_path
    was, told = module.stat(), folder / "told.txt"
    operator = get_operator(mutation.operator_name)(**mutation.operator_args)
    before, after = apply_mutation(module, operator, mutation.occurrence)
    try:
        outcome = judge(folder, tests_of(str(mutation.module_path), folder), told)
    finally:
        module.write_text(before, encoding="utf-8")
        os.utime(module, ns=(was.st_atime_ns, was.st_mtime_ns))  # what is compiled of it stays good
    if outcome == STILLBORN:
        return WorkResult(WorkerOutcome.ABNORMAL, told.read_text("utf-8"))
    noticed = TestOutcome.KILLED if outcome == KILLED else TestOutcome.SURVIVED
    return WorkResult(
        WorkerOutcome.NORMAL, told.read_text("utf-8"), noticed, difference(before, after)
    )


def check_without(part: str, folder: Path) -> None:
    """Leave unless the tests of a part pass where nothing is planted: else all would be noticed."""
    tests, told = tests_of(part, folder), folder / "told.txt"
    if judge(folder, tests, told, kept=True) != SURVIVED:
        raise SystemExit(f"{told.read_text('utf-8')}\nthe tests of {part} fail without any mutant")


def judge_part(part: str, count: int, again: bool, folder: Path) -> None:
    """Judge the first so many mutants of a part that were not yet, or those that survived."""
    with use_db(session(part)) as mutants:
        results = dict(mutants.results)
        chosen = drawn(part, mutants)[:count]
        if again:
            survived = [id_ for id_, its in results.items() if not its.is_killed]
            waiting = [item for item in chosen if item.job_id in survived]
        else:
            waiting = [item for item in chosen if item.job_id not in results]
        if waiting:
            check_without(part, folder)
        for item in tqdm(waiting, part, mininterval=10):
            mutants.set_result(item.job_id, try_out(item.mutations[0], folder))


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("parts", nargs="*", default=list(TESTS), metavar="PART")
    parser.add_argument("--count", type=int, default=100, help="of mutants, in each part")
    parser.add_argument("--again", action="store_true", help="those that survived")
    its = parser.parse_args(arguments)
    import_all()
    with tempfile.TemporaryDirectory() as name:
        copy_of_the_project(Path(name))
        os.chdir(name)  # what is edited meanwhile changes nothing
        for part in its.parts:
            judge_part(part, its.count, its.again, Path(name))
        write_page({part: session(part) for part in TESTS})
        os.chdir(ROOT)


if __name__ == "__main__":
    main()
