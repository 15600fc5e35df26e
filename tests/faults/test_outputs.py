"""A command that is killed while it writes leaves all of its output, or nothing."""

import os
import signal
import sys

from recalib.files.outputs import write_new
from tests.laboratory.test_outputs import TWO, content

EVENTS = {"open", "os.mkdir", "os.rename", "os.rmdir", "os.remove", "os.listdir", "os.scandir"}


def be_killed_at(number: int) -> None:
    """Have this process killed where it touches a file for the n-th time from now."""
    left = [number]

    def hook(event: str, _) -> None:
        if event in EVENTS:
            left[0] -= 1
            if not left[0]:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(hook)


def test_killed_at_any_moment_it_leaves_all_or_nothing_and_the_next_run_tidies_up(tmp_path):
    number, killed = 0, True
    while killed:
        number += 1
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "mine").write_text("mine")
        if not (child := os.fork()):
            be_killed_at(number)
            write_new(folder / "out", TWO)
            os._exit(0)
        _, status = os.waitpid(child, 0)
        killed = os.WIFSIGNALED(status)
        names = {path.name for path in folder.iterdir() if not path.name.startswith(".recalib-")}
        assert names <= {"mine", "out"}
        if "out" not in names:
            assert killed
            write_new(folder / "out", TWO)
            assert {path.name for path in folder.iterdir()} == {"mine", "out"}
        assert content(folder / "out") == TWO
        assert (folder / "mine").read_text() == "mine"
    assert number > 5
