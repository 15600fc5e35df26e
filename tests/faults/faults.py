"""Every fault that is tried: what is done, and what then holds.

Each takes a yard, returns how the project survived, and raises Broken where it did not, or
NotTried where this machine cannot show it.
"""

import itertools
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from tests.faults.yard import NotTried, Yard, made, whole
from tests.project import Project, ended, expect, kill

Fault = Callable[[Yard], str]
RESULTS = Path("results/studies/faults")
FAULTS: dict[str, Fault] = {}
SHORT: list[str] = []  # the names of those that take little time
SAME = "same results as undisturbed, no strays"
CHAIN = 6  # times that everything is killed before a run may end
INTERMEDIATE = (  # of each kind of file that a job reads, one
    "scenarios/translation.json",
    "chunks/search/improved_20.0.csv",
    "chunks/runs/translation/improved.0.parquet",
    "chunks/runs/translation/improved.0.npz",
    "figures/figure1.svg",
)
LAST = ("recordings/translation.rrd", "runs/translation/improved.npz")  # no job reads these


def tried(name: str, short: bool = False) -> Callable[[Fault], Fault]:
    """Put a fault on the list."""

    def add(fault: Fault) -> Fault:
        FAULTS[name] = fault
        if short:
            SHORT.append(name)
        return fault

    return add


def begun(yard: Yard) -> tuple[Project, subprocess.Popen]:
    """A run from the beginning that is at work."""
    project = yard.bare()
    process = project.start()
    project.at_work(process)
    return project, process


def goes_on(yard: Yard, project: Project) -> None:
    """The next run ends well, with what an undisturbed run makes."""
    project.run().well()
    yard.finished(project)


@tried("kill -9 of all processes at random moments, run again each time")
def killed(yard: Yard) -> str:
    project, luck = yard.bare(), random.Random(1996)
    for _ in range(CHAIN):
        process = project.start()
        project.at_work(process)
        time.sleep(luck.uniform(0, 3))
        kill(process)
    goes_on(yard, project)
    return f"{CHAIN} times; then {SAME}"


@tried("kill -9 of one job")
def job_killed(yard: Yard) -> str:
    project = yard.bare()
    process = project.start()
    project.at_work(process)[0].kill()
    ended(process).badly()
    goes_on(yard, project)
    return f"the run fails; the next one: {SAME}"


@tried("interrupted (Ctrl-C)")
def interrupted(yard: Yard) -> str:
    project, process = begun(yard)
    time.sleep(2)  # while Python itself is still beginning, it answers in its own words
    os.killpg(process.pid, signal.SIGINT)
    ended(process).badly()
    goes_on(yard, project)
    return f"the run ends; the next one: {SAME}"


@tried("two runs at once, the same study")
def twice(yard: Yard) -> str:
    project, first = begun(yard)
    waiting = project.run().told(f"another run is at work in {RESULTS}: wait until it has ended")
    expect(waiting.said.count("at work in") == 1, "one sentence")
    ended(first).well()
    yard.finished(project)
    return "the second is told to wait; " + SAME


@tried("two runs at once, different studies, one killed and run again")
def side_by_side(yard: Yard) -> str:
    project, other = yard.bare(), ("--config", "name=other", "seed=7")
    second = project.start(*other)
    project.at_work(second)
    first = project.start()
    time.sleep(1)
    kill(second)
    project.run(*other).well()
    ended(first).well()
    yard.finished(project)
    alone = yard.bare()
    alone.run(*other).well()
    here, there = (made(its.results.with_name("other")) for its in (project, alone))
    expect(here == there, "the results of the second as if it were alone")
    return "both end, each with its own results"


def flipped(data: bytes) -> bytes:
    """A byte in the middle is another."""
    half = len(data) // 2
    return data[:half] + bytes([data[half] ^ 1]) + data[half + 1 :]


DAMAGE = {
    "a flipped byte": flipped,
    "its end cut off": lambda data: data[: len(data) // 2],
    "nothing in it": lambda data: b"",
}


@tried("an intermediate file of each kind (json, csv, parquet, npz, svg) damaged")
def damaged(yard: Yard) -> str:
    for file, damage in zip(INTERMEDIATE, itertools.cycle(DAMAGE.values())):
        project = yard.done()
        path = project.results / file
        path.write_bytes(damage(path.read_bytes()))
        project.run().told(f"damaged since it was written, and removed: {RESULTS / file}")
        # what was made from it while it was whole does not need it
        project.run("--", "all", *(f"{RESULTS}/{its}" for its in yard.expected)).well()
        yard.finished(project)
    return f"{', '.join(DAMAGE)} in turn: each named and removed, then made anew"


@tried("a result that no job reads (rrd, npz) damaged")
def last_damaged(yard: Yard) -> str:
    project = yard.done()
    for file in LAST:
        path = project.results / file
        path.write_bytes(flipped(path.read_bytes()))
    verify = [os.sys.executable, "-m", "workflow.digests", str(RESULTS)]
    ran = subprocess.run(verify, cwd=project.folder, capture_output=True, text=True, check=False)
    said = ran.stderr
    expect(ran.returncode != 0 and all(file in said for file in LAST), "all are named", said)
    expect(said.count("\n") == 1, "it says one sentence", said)
    goes_on(yard, project)
    return "make verify names and removes them; then made anew"


@contextmanager
def small_disk(project: Project, megabytes: int):
    """The project's results on a disk that is nearly full. Yields how it was done."""
    disk = project.folder / "results"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        limit = megabytes * 2**20 // 4
        yield (
            f"files of at most {limit} bytes, since nothing may be mounted here",
            {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))},
        )
        return
    try:
        yield f"a disk of {megabytes} MB", {}
        kept = project.folder / "kept"
        shutil.copytree(disk, kept, symlinks=True)
    finally:
        subprocess.run(["umount", str(disk)], check=True)
    disk.rmdir()
    kept.rename(disk)


@tried("disk full, then room again")
def disk_full(yard: Yard) -> str:
    size = sum(path.stat().st_size for path in yard.done().results.rglob("*") if path.is_file())
    ways = set()
    for part in (0.02, 0.5):
        project = yard.bare()
        with small_disk(project, max(1, int(part * size / 2**20))) as (way, options):
            project.run(**options).badly()
            whole(project)
            ways.add(way)
        project.run().well()
        yard.finished(project)
    return f"{', '.join(sorted(ways))}: said in a sentence; then {SAME}"


@contextmanager
def read_only(folder: Path):
    """Nothing can be written below a folder."""
    if os.geteuid():
        _permit(folder, writing=False)
        yield
        _permit(folder, writing=True)
        return
    for how in (["--bind", folder, folder], ["-o", "remount,ro,bind", folder]):
        mounted = subprocess.run(["mount", *how], capture_output=True, check=False)
        if mounted.returncode:
            raise NotTried("nothing may be mounted here, and permissions do not stop root")
    try:
        yield
    finally:
        subprocess.run(["umount", folder], check=True)


def _permit(folder: Path, writing: bool) -> None:
    for path in (folder, *folder.rglob("*")):
        mode = path.stat().st_mode
        path.chmod(mode | 0o200 if writing else mode & ~0o222)


@tried("a folder of results that is read-only", short=True)
def results_read_only(yard: Yard) -> str:
    project = yard.done()
    with read_only(project.folder / "results"):
        project.run().well()  # there is nothing to do
        project.run("--forcerun", "summary").told("Write-protected output files")
    yard.finished(project)
    return "said in a sentence; results as before"


@tried("a project that is read-only")
def all_read_only(yard: Yard) -> str:
    project = yard.done()
    with read_only(project.folder):
        project.run("--forcerun", "summary").badly()
    yard.finished(project)
    return "said in a sentence; results as before"


CACHES = "NUMBA_CACHE_DIR", "MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"
PLAIN = {"LC_ALL": "C", "LANG": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
# Under which a run from the beginning is like any other.
CIRCUMSTANCES = {
    "no home folder": {"environment": dict.fromkeys(("HOME", *CACHES))},
    "a home folder that is not there and cannot be made": {
        "environment": dict.fromkeys(CACHES) | {"HOME": "/proc/nowhere"}
    },
    "LC_ALL=C, PYTHONUTF8=0": {"environment": PLAIN},
    "a path with spaces, quotes and letters of other alphabets": {
        "folder": "a b's \u0440\u0443\u043a\u0430 \u624b\u81c2 $x"
    },
    "no terminal, no input, TERM unset": {
        "environment": dict.fromkeys(("TERM", "COLUMNS", "DISPLAY")),
        "stdin": None,
    },
    "umask 077": {"umask": 0o077},
    "umask 000": {"umask": 0o000},
}


def under(yard: Yard, folder: str = "project", **options) -> str:
    project = yard.bare(folder)
    project.run(**options).well()
    yard.finished(project)
    return SAME


FAULTS |= {name: partial(under, **options) for name, options in CIRCUMSTANCES.items()}


@tried("the clock goes back by a day in the middle, then right again")
def clock(yard: Yard) -> str:
    if not shutil.which("faketime"):
        raise NotTried("faketime is not installed")
    project = yard.bare()
    project.run("--until", "train_chunk").well()
    project.run(before=["faketime", "-f", "-1d"]).told("has older modification time")
    goes_on(yard, project)
    return f"Snakemake says what is older than what; then {SAME}"


@tried("results dated ahead by a day, and a setting changed; then dated right")
def ahead(yard: Yard) -> str:
    project = yard.done()

    def date(then: float) -> None:
        for path in project.results.rglob("*"):
            os.utime(path, (then, then))

    now = time.time()
    date(now + 86400)
    changed = project.run("--config", "training={tests: 11}")
    changed.told("has older modification time")
    date(now)
    goes_on(yard, project)
    return f"Snakemake says what is older than what; then {SAME}"


@tried(".snakemake deleted and a setting changed", short=True)
def notes_deleted(yard: Yard) -> str:
    project = yard.done()
    shutil.rmtree(project.folder / ".snakemake")
    other = "--config", "training={tests: 11}"
    project.run(*other).told(f"remove {RESULTS}, or, if nothing was changed since,")
    (project.results / ".running").unlink()
    goes_on(yard, project)
    return "said in a sentence, with what to remove"


@tried("no network for `real`", short=True)
def no_network(yard: Yard) -> str:
    nowhere = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
    project = yard.done()
    ran = project.run("--", "results/studies/faults/real/fit.csv", environment=nowhere)
    ran.told("real_data: ")
    yard.finished(project)
    return "said in a sentence"
