"""What commands write is new, whole and at once, and whatever was there before stays."""

import os
import re
import shutil
import signal
import sys
import tempfile
from contextlib import chdir, redirect_stderr, suppress
from io import StringIO
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recalib.errors import InvalidFile
from recalib.files.outputs import MARK, new
from recalib.laboratory import calibrate
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.report import files
from recalib.laboratory.report.files import NAMES

LINKS = "joint,a [mm],alpha [deg],d [mm],theta [deg]\nwaist,0,-90,412,0\nboom,300,0,0,0\n"
INPUTS = "arm.urdf", "rows.csv", "links.csv"


@pytest.fixture(scope="module")
def laboratory(calibrated, tmp_path_factory):
    """A folder with an arm, its measurements and a calibration of it, which is not made again.

    What matters here is where results are put.
    """
    folder = tmp_path_factory.mktemp("laboratory")
    shutil.copy(calibrated.parent / "arm.urdf", folder)
    shutil.copy(calibrated.parent / "measurements.csv", folder / "rows.csv")
    (folder / "links.csv").write_text(LINKS)
    result = calibrate.calibrate_arm(folder / "arm.urdf", folder / "rows.csv")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(calibrate, "calibrate_arm", lambda *_: result)
        patch.setattr(files, "optional_outputs", lambda: ([], []))
        assert run(folder, "calibrate", "arm.urdf", "rows.csv")[0] == DONE
        yield folder


def run(folder, *arguments: str) -> tuple[int, str]:
    """How a command ended, and what it said."""
    with chdir(folder), redirect_stderr(StringIO()) as said:
        return main(arguments), said.getvalue()


def content(folder: Path) -> dict[str, object]:
    """What every path below a folder is: a link's goal, a file's bytes, or else its kind."""
    its = {}
    for path in folder.rglob("*"):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            its[name] = os.readlink(path)
        else:
            its[name] = path.read_bytes() if path.is_file() else path.lstat().st_mode
    return its


COMMANDS = {
    "calibrate": ("calibrate", "arm.urdf", "rows.csv"),
    "correct": ("correct", "calibration", "rows.csv"),
    "next": ("next", "calibration", "--count=1"),
    "urdf": ("urdf", "links.csv"),
}


@pytest.mark.parametrize(
    ("out", "sentence"),
    [
        ("", "recalib: --out is ''; expected: the name of a file or folder"),
        ("rows.csv/new", "nothing can be made in .*rows.csv; try: another --out"),
        ("x" * 300, "File name too long"),
        ("/", "cannot use /: it is there already"),
    ],
)
def test_where_nothing_can_be_made_it_is_told_in_a_sentence(out, sentence, laboratory):
    code, told = run(laboratory, *COMMANDS["urdf"], f"--out={out}")
    assert code == REFUSED
    assert re.search(sentence, told) and told.count("\n") == 1


def test_an_empty_folder_will_do_and_parents_are_made(laboratory, tmp_path):
    (tmp_path / "empty").mkdir()
    for out in (tmp_path / "empty", tmp_path / "a" / "b"):
        with new(out, folder=True) as made:
            (made / "file").write_text("whole")
        assert [path.name for path in out.iterdir()] == ["file"]
    assert {path.name for path in tmp_path.iterdir()} == {"empty", "a"}


HIDDEN = ".calibration.part", ".commands.csv.part"  # where commands make their results
NAME = st.sampled_from(
    [*INPUTS, *NAMES, *HIDDEN, "calibration", "notes.txt", ".hidden", "ä b", "commands.csv"]
)
ENTRY = st.one_of(
    st.tuples(st.just("file"), st.binary(max_size=4)),
    st.tuples(st.just("link"), NAME),
    st.tuples(st.just("pipe"), st.none()),
    st.tuples(st.just("folder"), st.dictionaries(NAME, st.binary(max_size=4), max_size=3)),
)


def fill(folder: Path, entries: dict) -> None:
    for name, (kind, its) in entries.items():
        path = folder / name
        if kind == "file":
            path.write_bytes(its)
        elif kind == "link":
            path.symlink_to(its)
        elif kind == "pipe":
            os.mkfifo(path)
        else:
            path.mkdir()
            fill(path, {name: ("file", its) for name, its in its.items()})


@settings(max_examples=100)
@given(
    entries=st.dictionaries(NAME, ENTRY, max_size=5),
    command=st.sampled_from([*COMMANDS]),
    out=st.one_of(st.none(), NAME, st.tuples(NAME, NAME).map("/".join), st.just(".")),
)
def test_after_any_run_all_that_was_there_is_as_it_was(laboratory, entries, command, out):
    """Links and pipes among it, also to nothing: a run adds something, or says why it does not.

    Only an empty folder where results are made is taken for what a killed run left.
    """
    for name in HIDDEN:
        if entries.get(name) == ("folder", {}):
            del entries[name]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        fill(folder, entries)
        for name in {*INPUTS} - entries.keys():
            (folder / name).write_bytes((laboratory / name).read_bytes())
        if "calibration" not in entries and out != "calibration":
            shutil.copytree(laboratory / "calibration", folder / "calibration")
        before = content(folder)
        code, told = run(folder, *COMMANDS[command], *([] if out is None else [f"--out={out}"]))
        after = content(folder)
        if out in entries and (entries[out][0] != "folder" or entries[out][1]):
            assert f"recalib: cannot use {out}: it is there already, and nothing" in told
        assert {name: after.get(name) for name in before} == before
        added = after.keys() - before.keys()
        assert bool(added) == (code == DONE)
        assert ".part" in str(out) or not [name for name in added if ".part" in name]


@pytest.fixture
def strike():
    """A function that has something done where files are touched for the n-th time from now.

    It returns what ends the waiting, and tells whether it was in vain.
    """
    events = {"open", "os.mkdir", "os.rename", "os.rmdir", "os.remove", "os.listdir", "os.scandir"}
    waiting = []

    def hook(event: str, _) -> None:
        if waiting and event in events:
            waiting[0] -= 1
            if not waiting[0]:
                waiting.pop(0)
                waiting.pop(0)()

    sys.addaudithook(hook)

    def at(number: int, do):
        waiting[:] = [number, do]

        def in_vain() -> bool:
            left = bool(waiting)
            waiting.clear()
            return left

        return in_vain

    yield at
    waiting.clear()


def test_killed_at_any_moment_it_leaves_all_or_nothing_and_the_next_run_tidies_up(tmp_path, strike):
    number, killed = 0, True
    while killed:
        number += 1
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "mine").write_text("mine")
        if not (child := os.fork()):
            strike(number, lambda: os.kill(os.getpid(), signal.SIGKILL))
            fill_two(folder / "out")
            os._exit(0)
        _, status = os.waitpid(child, 0)
        killed = os.WIFSIGNALED(status)
        names = {path.name for path in folder.iterdir()}
        assert names <= {"mine", "out", ".out.part"}
        if "out" not in names:
            assert killed
            fill_two(folder / "out")
            assert {path.name for path in folder.iterdir()} == {"mine", "out"}
        assert content(folder / "out") == {"one": b"1", "two": b"2"}
        assert (folder / "mine").read_text() == "mine"
    assert number > 5


def fill_two(folder: Path) -> None:
    with new(folder, folder=True) as made:
        (made / "one").write_text("1")
        (made / "two").write_text("2")


@pytest.mark.parametrize("command", ["calibrate", "urdf"])
def test_what_is_told_of_an_interruption_is_true(command, laboratory, tmp_path, strike):
    def interrupt():
        raise KeyboardInterrupt

    number, struck, whole = 0, True, None
    while struck:
        number, out = number + 1, tmp_path / str(number)
        in_vain = strike(number, interrupt)
        code, told = run(laboratory, *COMMANDS[command], f"--out={out}")
        struck = not in_vain()
        if struck and code == REFUSED:
            how = "there, and whole" if out.exists() else "not written"
            assert told.splitlines()[-1] == f"recalib: interrupted; {out} is {how}"
        if out.exists():
            its = content(out) if out.is_dir() else out.read_bytes()
            assert whole in (None, its)
            whole = its
    assert number > 5 and whole is not None


def test_what_lies_where_results_are_made_stays_unless_it_is_marked(tmp_path):
    (tmp_path / ".out.part" / "out").mkdir(parents=True)
    (tmp_path / ".out.part" / "out" / "mine").write_text("mine")
    before = content(tmp_path)
    with pytest.raises(InvalidFile, match=r"\.out\.part: it is in the way of what will be made"):
        fill_two(tmp_path / "out")
    assert content(tmp_path) == before
    (tmp_path / ".out.part" / MARK).touch()
    fill_two(tmp_path / "out")
    assert {path.name for path in tmp_path.iterdir()} == {"out"}


def test_killed_while_it_cleans_up_after_an_error_the_next_run_tidies_up(tmp_path, strike):
    number, killed = 0, True
    while killed:
        number += 1
        out = tmp_path / str(number) / "out"
        out.parent.mkdir()
        if not (child := os.fork()):
            with suppress(ZeroDivisionError), new(out, folder=True) as made:
                (made / "one").touch()
                strike(number, lambda: os.kill(os.getpid(), signal.SIGKILL))
                1 / 0  # noqa: B018
            os._exit(0)
        _, status = os.waitpid(child, 0)
        killed = os.WIFSIGNALED(status)
        fill_two(out)
        assert {path.name for path in out.parent.iterdir()} == {"out"}
    assert number > 3


def test_two_at_once_do_not_mix(tmp_path):
    with new(tmp_path / "out") as made:
        made.write_text("whole")
        with pytest.raises(InvalidFile, match="another process fills it; try: another --out"):
            fill_two(tmp_path / "out")
    assert content(tmp_path) == {"out": b"whole"}


def test_where_nothing_can_be_made_one_is_told_of_the_name_that_was_asked_for(
    tmp_path, monkeypatch
):
    def mkdir(path, **options):
        raise FileNotFoundError(2, "No such file or directory", str(path))

    monkeypatch.setattr(Path, "mkdir", mkdir)
    said = "new: nothing can be made in .*: No such file"
    with pytest.raises(InvalidFile, match=said), new(tmp_path / "new"):
        pass
