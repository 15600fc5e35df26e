"""Small random errors: how many of them do the tests notice?

cosmic-ray makes them, one at a time, in a copy of the project: its own, and those that a scientist
makes (`operators`). They are taken in an order drawn by a fixed seed, so that a sample can be made
larger. Results are kept in results/mutants and shown in docs/mutants.md. A change of a part's
code begins it anew; after a change of tests, `--again` has them meet the survivors.

    python -m tests.mutants campaign --count 30
"""

import argparse
import hashlib
import itertools
import os
import random
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from cosmic_ray.commands import init
from cosmic_ray.mutating import apply_mutation
from cosmic_ray.plugins import get_operator
from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import MutationSpec, TestOutcome, WorkerOutcome, WorkItem, WorkResult
from tqdm import tqdm

from tests.mutants import operators
from tests.mutants.judging import KILLED, STILLBORN, SURVIVED, Keep, import_all, judge
from tests.mutants.nearest import Reach, nearest, reach
from tests.mutants.page import difference, write_page
from tests.mutants.parts import PARTS, THOROUGH, TIMES, modules

ROOT, SEED = Path(__file__).parents[2], 2030
KEPT = ROOT / "results" / "mutants"
OTHERS = "others"  # the operators that cosmic-ray has
LOG = "pytest.log"  # in the copy of the project


def session_file(part: str) -> Path:
    """The file of a part's mutants and results; a new one when the part or operators change."""
    read = [*modules(part), Path(operators.__file__)]
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in read))
    return KEPT / f"{part}.{digest.hexdigest()[:12]}.sqlite"


def session(part: str) -> Path:
    """The session file of a part, made if there is none."""
    path = session_file(part)
    if not path.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        for older in KEPT.glob(f"{part}.*.sqlite"):
            older.unlink()
        with use_db(path) as mutants:
            init(modules(part), mutants, {})
    return path


def in_order(part: str, mutants: WorkDB) -> list[WorkItem]:
    """All mutants of a part, in the order in which they are to be judged.

    The operators of science and one group of all the others take turns, so that neither a rare
    operator is missed nor unlikely errors fill the sample.
    """
    by_kind: dict[str, list[WorkItem]] = {}
    for item in sorted(mutants.work_items, key=lambda item: repr(item.mutations)):
        by_kind.setdefault(kind(item), []).append(item)
    for name, group in by_kind.items():
        random.Random(f"{SEED} {part} {name}").shuffle(group)
    others = by_kind.pop(OTHERS, [])
    turns = itertools.zip_longest(*(by_kind[name] for name in sorted(by_kind)))
    own = [item for turn in turns for item in turn if item]
    pairs = itertools.zip_longest(own, others)
    return [item for pair in pairs for item in pair if item]


def kind(item: WorkItem) -> str:
    """The operator's name if it is one of science."""
    provider, name = item.mutations[0].operator_name.split("/")
    return name if provider == operators.PROVIDER else OTHERS


def copy_of_the_project(folder: Path) -> None:
    """Copy the files that git tracks, or would track, to a new folder."""
    shutil.rmtree(folder, ignore_errors=True)
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, names.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def try_out(mutation: MutationSpec, folder: Path, reached: Mapping[str, Reach]) -> WorkResult:
    """Whether the tests notice a mutant in a copy of the project, which is left as it was."""
    module = folder / mutation.module_path
    status, log = module.stat(), folder / LOG
    tests = nearest(Path(mutation.module_path), mutation.start_pos[0], reached)
    operator = get_operator(mutation.operator_name)(**mutation.operator_args)
    before, after = apply_mutation(module, operator, mutation.occurrence)
    try:
        outcome = judge(folder, tests, log, 3 * sum(reached[test].seconds for test in tests))
    finally:
        module.write_text(before, encoding="utf-8")
        # with its old times, so that the compiled files stay valid
        os.utime(module, ns=(status.st_atime_ns, status.st_mtime_ns))
    if outcome == STILLBORN:
        return WorkResult(WorkerOutcome.ABNORMAL, log.read_text("utf-8"))
    test_outcome = TestOutcome.KILLED if outcome == KILLED else TestOutcome.SURVIVED
    return WorkResult(
        WorkerOutcome.NORMAL, log.read_text("utf-8"), test_outcome, difference(before, after)
    )


def reach_of(part: str, folder: Path) -> dict[str, Reach]:
    """What the tests of a part reach. Leave unless they pass where nothing is planted."""

    def run(files: list[str], keep: Keep) -> None:
        log = folder / LOG
        if judge(folder, files, log, keep=keep) != SURVIVED:
            raise SystemExit(f"{log.read_text('utf-8')}\n{part}: tests fail without a mutant")

    return reach(PARTS[part].tests, KEPT, run)


def judge_part(part: str, count: int, again: bool, folder: Path) -> None:
    """Judge the first so many mutants of a part that were not yet, or those that survived."""
    with use_db(session(part)) as mutants:
        results = dict(mutants.results)
        chosen = in_order(part, mutants)[:count]
        if again:
            survived = [id_ for id_, result in results.items() if not result.is_killed]
            waiting = [item for item in chosen if item.job_id in survived]
        else:
            waiting = [item for item in chosen if item.job_id not in results]
        reached = reach_of(part, folder) if waiting else {}
        for item in tqdm(waiting, part, mininterval=10):
            mutants.set_result(item.job_id, try_out(item.mutations[0], folder, reached))


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("parts", nargs="*", default=list(PARTS), metavar="PART")
    counted = "of mutants in each part, five times as many where an arm moves or an error is stated"
    parser.add_argument("--count", type=int, default=20, help=counted)
    parser.add_argument("--again", action="store_true", help="those that survived")
    options = parser.parse_args(arguments)
    operators.register()
    import_all()
    copy = KEPT / "project"  # in the same place each time, so that compiled files stay valid
    copy_of_the_project(copy)
    os.chdir(copy)  # what is edited meanwhile changes nothing
    for part in options.parts:
        count = options.count * (TIMES if part in THOROUGH else 1)
        judge_part(part, count, options.again, copy)
    sessions = {part: session_file(part) for part in PARTS}
    if missing := [part for part, path in sessions.items() if not path.exists()]:
        print(f"docs/mutants.md stays as it is: {', '.join(missing)} must be judged first")
    else:
        write_page(sessions)
    os.chdir(ROOT)


if __name__ == "__main__":
    main()
