"""After every fault, a run has the results of an undisturbed one, and leaves no strays."""

import os
import random
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.faults.project import Project, expect, kill, outcome_of
from tests.faults.yard import Yard, at_work, digests_of, expect_no_strays

RESULTS = Path("results/studies/faults")
CHAIN = 6  # times that everything is killed before a run may end


@pytest.fixture(scope="session")
def yard():
    # what is started in the background ignores Ctrl-C, and so would all runs
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with tempfile.TemporaryDirectory(prefix="faults") as folder:
        yield Yard(Path(folder))


def started_run(yard: Yard) -> tuple[Project, subprocess.Popen]:
    """A run from the beginning that is at work."""
    project = yard.bare()
    process = project.start()
    at_work(project, process)
    return project, process


def expect_next_run_finishes(yard: Yard, project: Project) -> None:
    """Expect that the next run ends well, with the results of an undisturbed run."""
    project.run().expect_success()
    yard.expect_results(project)


@pytest.mark.slow
def test_all_processes_are_killed_at_random_moments_and_run_again_each_time(yard):
    project, rng = yard.bare(), random.Random(1996)
    for _ in range(CHAIN):
        process = project.start()
        at_work(project, process)
        time.sleep(rng.uniform(0, 3))
        kill(process)
    expect_next_run_finishes(yard, project)


@pytest.mark.slow
def test_one_job_is_killed(yard):
    project = yard.bare()
    process = project.start()
    at_work(project, process)[0].kill()
    outcome_of(process).expect_failure()
    expect_next_run_finishes(yard, project)


@pytest.mark.slow
def test_it_is_interrupted(yard):
    project, process = started_run(yard)
    time.sleep(2)  # earlier, Python itself would answer with a traceback
    os.killpg(process.pid, signal.SIGINT)
    outcome_of(process).expect_failure()
    expect_next_run_finishes(yard, project)


@pytest.mark.slow
def test_a_second_run_of_the_same_study_is_refused(yard):
    project, first = started_run(yard)
    waiting = project.run().expect_refusal(
        f"another run is at work in {RESULTS}: wait until it has ended"
    )
    expect(waiting.output.count("at work in") == 1, "one sentence")
    outcome_of(first).expect_success()
    yard.expect_results(project)


@pytest.mark.slow
def test_two_studies_run_at_once_and_one_is_killed_and_run_again(yard):
    project, options = yard.bare(), ("--config", "name=other", "seed=7")
    second = project.start(*options)
    at_work(project, second)
    first = project.start()
    time.sleep(1)
    kill(second)
    project.run(*options).expect_success()
    outcome_of(first).expect_success()
    yard.expect_results(project)
    alone = yard.bare()
    alone.run(*options).expect_success()
    here, there = (digests_of(copy.results.with_name("other")) for copy in (project, alone))
    expect(here == there, "the results of the second as if it were alone")


@contextmanager
def small_disk(project: Project, megabytes: int):
    """The project's results on a disk that is nearly full. Yields options of the run.

    Where nothing may be mounted, files are limited instead.
    """
    disk = project.folder / "results"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        limit = megabytes * 2**20 // 4
        yield {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))}
        return
    try:
        yield {}
        copy = project.folder / "kept"
        shutil.copytree(disk, copy, symlinks=True)
    finally:
        subprocess.run(["umount", str(disk)], check=True)
    disk.rmdir()
    copy.rename(disk)


@pytest.mark.slow
def test_the_disk_is_full_and_then_there_is_room_again(yard):
    size = sum(path.stat().st_size for path in yard.complete().results.rglob("*") if path.is_file())
    for part in (0.02, 0.5):
        project = yard.bare()
        with small_disk(project, max(1, int(part * size / 2**20))) as options:
            project.run(**options).expect_failure()
            expect_no_strays(project)
        project.run().expect_success()
        yard.expect_results(project)


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
            pytest.skip("nothing may be mounted here, and permissions do not stop root")
    try:
        yield
    finally:
        subprocess.run(["umount", folder], check=True)


def _permit(folder: Path, writing: bool) -> None:
    for path in (folder, *folder.rglob("*")):
        mode = path.stat().st_mode
        path.chmod(mode | 0o200 if writing else mode & ~0o222)


def test_a_folder_of_results_is_read_only(yard):
    project = yard.complete()
    with read_only(project.folder / "results"):
        project.run().expect_success()  # there is nothing to do
        project.run("--forcerun", "summary").expect_refusal("Write-protected output files")
    yard.expect_results(project)


@pytest.mark.slow
def test_a_project_is_read_only(yard):
    project = yard.complete()
    with read_only(project.folder):
        project.run("--forcerun", "summary").expect_failure()
    yard.expect_results(project)


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


@pytest.mark.slow
@pytest.mark.parametrize("circumstance", CIRCUMSTANCES)
def test_a_run_is_like_any_other(circumstance, yard):
    options = dict(CIRCUMSTANCES[circumstance])
    project = yard.bare(options.pop("folder", "project"))
    project.run(**options).expect_success()
    yard.expect_results(project)


@pytest.mark.slow
def test_the_clock_goes_back_by_a_day_in_the_middle_and_is_then_right_again(yard):
    if not shutil.which("faketime"):
        pytest.skip("faketime is not installed")
    project = yard.bare()
    project.run("--until", "train_ur10_translation").expect_success()
    project.run(before=["faketime", "-f", "-1d"]).expect_refusal("has older modification time")
    expect_next_run_finishes(yard, project)


@pytest.mark.slow
def test_results_are_dated_ahead_by_a_day_and_a_setting_is_changed(yard):
    project = yard.complete()

    def date(then: float) -> None:
        for path in project.results.rglob("*"):
            os.utime(path, (then, then))

    now = time.time()
    date(now + 86400)
    run = project.run("--config", "training={tests: 11}")
    run.expect_refusal("has older modification time")
    date(now)
    expect_next_run_finishes(yard, project)


def test_snakemakes_notes_are_deleted_and_a_setting_is_changed(yard):
    project = yard.complete()
    shutil.rmtree(project.folder / ".snakemake")
    options = "--config", "training={tests: 11}"
    project.run(*options).expect_refusal(f"remove {RESULTS} or, if nothing has changed since,")
    (project.results / ".running").unlink()
    expect_next_run_finishes(yard, project)


def test_there_is_no_network_for_the_real_arm(yard):
    nowhere = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
    project = yard.complete()
    run = project.run("--", "results/studies/faults/real/fit.csv", environment=nowhere)
    run.expect_refusal("real_data: ")
    yard.expect_results(project)
