import multiprocessing
import os
import signal

import pytest

from recalib.storage import whole
from workflow.alone import MARK, Busy, hold


def killed_while_writing(path):
    with whole(path) as temporary:
        temporary.write_text("half")
        os.kill(os.getpid(), signal.SIGKILL)


def held_elsewhere(folder, answers):
    try:
        answers.put(hold([folder]))
    except Busy as error:
        answers.put(str(error))


@pytest.fixture
def results(tmp_path):
    """A folder of results with what killed processes left there, and in another study's."""
    for path in (tmp_path / "runs/a.parquet", tmp_path / "studies/b/runs/a.parquet"):
        process = multiprocessing.get_context("spawn").Process(
            target=killed_while_writing, args=(path,)
        )
        process.start()
        process.join()
    (tmp_path / "runs/b.parquet").write_text("whole")
    return tmp_path


def test_what_a_killed_run_left_is_swept_up_and_nothing_else(results):
    assert len(list(results.rglob(".*"))) == 2
    hold([str(results)])
    left = {str(path.relative_to(results)) for path in results.rglob("*") if path.is_file()}
    (elsewhere,) = (results / "studies/b/runs").iterdir()
    assert left == {"runs/b.parquet", MARK, str(elsewhere.relative_to(results))}


def test_a_folder_is_held_until_the_process_ends(tmp_path):
    context = multiprocessing.get_context("spawn")
    answers = context.Queue()
    mine, ours = str(tmp_path / "mine"), str(tmp_path / "ours")
    hold([ours])
    busy = f"another run is at work in {ours}: wait until it has ended"
    for folder, expected in ((mine, None), (mine, None), (ours, busy)):
        process = context.Process(target=held_elsewhere, args=(folder, answers))
        process.start()
        process.join()
        assert answers.get(timeout=10) == expected
