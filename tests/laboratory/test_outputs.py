"""What commands write is new, whole and read back, and whatever was there before stays."""

import os
import re
import resource
import shutil
import tempfile
from contextlib import chdir, redirect_stderr
from io import StringIO
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recalib import InvalidFile, calibrate_arm
from recalib.files import write_new
from recalib.laboratory import commands
from recalib.laboratory.command_line import DONE, REFUSED, main

LINKS = "joint,a [mm],alpha [deg],d [mm],theta [deg]\nwaist,0,-90,412,0\nboom,300,0,0,0\n"
INPUTS = "arm.urdf", "rows.csv", "links.csv"
TWO = {"one.txt": b"1", "two.txt": b"2"}


@pytest.fixture(scope="module")
def laboratory(calibrated, tmp_path_factory):
    """A folder with an arm, its measurements and a calibration of it, which is not made again.

    What matters here is where results are put.
    """
    folder = tmp_path_factory.mktemp("laboratory")
    shutil.copy(calibrated.parent / "arm.urdf", folder)
    shutil.copy(calibrated.parent / "measurements.csv", folder / "rows.csv")
    (folder / "links.csv").write_text(LINKS)
    result = calibrate_arm(folder / "arm.urdf", folder / "rows.csv")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(commands, "calibrate_arm", lambda *_: result)
        patch.setattr("recalib.laboratory.page_of", lambda _: b"a page")
        assert run(folder, "calibrate", "arm.urdf", "rows.csv")[0] == DONE
        yield folder


def run(folder, *arguments: str) -> tuple[int, str]:
    """How a command ended, and what it printed on stderr."""
    with chdir(folder), redirect_stderr(StringIO()) as printed:
        return main(arguments), printed.getvalue()


def content(folder: Path) -> dict[str, object]:
    """What every path below a folder is: a link's goal, a file's bytes, or else its kind."""
    found = {}
    for path in folder.rglob("*"):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = os.readlink(path)
        else:
            found[name] = path.read_bytes() if path.is_file() else path.lstat().st_mode
    return found


COMMANDS = {
    "calibrate": ("calibrate", "arm.urdf", "rows.csv"),
    "correct": ("correct", "calibration", "rows.csv"),
    "next": ("next", "calibration", "--count=1"),
    "urdf": ("urdf", "links.csv"),
}


def test_an_empty_folder_will_do_and_what_the_disk_gives_back_is_compared(tmp_path, monkeypatch):
    (tmp_path / "empty").mkdir()
    for out in (tmp_path / "empty", tmp_path / "a" / "b"):
        write_new(out, TWO)
        assert content(out) == TWO
    assert {path.name for path in tmp_path.iterdir()} == {"empty", "a"}
    monkeypatch.setattr(Path, "read_bytes", lambda path: b"other")
    with pytest.raises(InvalidFile, match=r"one\.txt: the disk returned other content"):
        write_new(tmp_path / "out", TWO)


OTHERS = "calibration", "notes.txt", ".hidden", "ä b", "commands.csv"
NAME = st.sampled_from([*INPUTS, *OTHERS])
ENTRY = st.one_of(
    st.tuples(st.just("file"), st.binary(max_size=4)),
    st.tuples(st.just("link"), NAME),
    st.tuples(st.just("pipe"), st.none()),
    st.tuples(st.just("folder"), st.dictionaries(NAME, st.binary(max_size=4), max_size=3)),
)


def fill(folder: Path, entries: dict) -> None:
    for name, (kind, value) in entries.items():
        path = folder / name
        if kind == "file":
            path.write_bytes(value)
        elif kind == "link":
            path.symlink_to(value)
        elif kind == "pipe":
            os.mkfifo(path)
        else:
            path.mkdir()
            fill(path, {name: ("file", part) for name, part in value.items()})


@settings(max_examples=100)
@given(
    entries=st.dictionaries(NAME, ENTRY, max_size=5),
    command=st.sampled_from([*COMMANDS]),
    out=st.one_of(st.none(), NAME, st.tuples(NAME, NAME).map("/".join), st.just(".")),
)
def test_after_any_run_all_that_was_there_is_as_it_was(laboratory, entries, command, out):
    """Links and pipes among it, also to nothing: a run adds something, or says why it does not."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        fill(folder, entries)
        for name in {*INPUTS} - entries.keys():
            (folder / name).write_bytes((laboratory / name).read_bytes())
        if "calibration" not in entries and out != "calibration":
            shutil.copytree(laboratory / "calibration", folder / "calibration")
        before = content(folder)
        code, printed = run(folder, *COMMANDS[command], *([] if out is None else [f"--out={out}"]))
        after = content(folder)
        if out in entries and (entries[out][0] != "folder" or entries[out][1]):
            assert f"recalib: cannot use {out}: it already exists and is not" in printed
        assert {name: after.get(name) for name in before} == before
        added = after.keys() - before.keys()
        assert bool(added) == (code == DONE)
        assert not [name for name in added if ".part" in name]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("arm.urdf", b"<robot><link name='\x01'/></robot>"),
        ("arm.urdf", b"<robot>"),
        ("a.csv", b"a,b\n1\n"),
        ("a.json", b'{"a": 1'),
        ("a.toml", b"a = \n"),
        ("a.yaml", b"a: [1"),
        ("a.npz", b"PK\x03\x04"),
        ("a.rrd", b"RRF2"),
        ("a.pdf", b"%PDF-1.4"),
        ("a.txt", b"\xff"),
    ],
)
def test_what_no_parser_reads_back_is_not_written(name, text, tmp_path):
    for out, files in (("folder", {"good.txt": b"", name: text}), (name, text)):
        with pytest.raises(InvalidFile, match=f"{name}: its computed content cannot be read"):
            write_new(tmp_path / out, files, Path(name).suffix)
    assert not [*tmp_path.iterdir()]


def test_on_a_full_disk_the_file_is_named_and_nothing_stays(laboratory, tmp_path):
    """A limit on the size of files fails in the same way as a disk without space."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    for command, size in (("calibrate", 3000), ("urdf", 100), ("next", 10), ("correct", 0)):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
        try:
            code, printed = run(laboratory, *COMMANDS[command], f"--out={tmp_path / 'out'}")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        last = printed.splitlines()[-1]
        assert code == REFUSED and re.search(r"out\S*: it cannot be written: File too large", last)
        assert not [*tmp_path.iterdir()]
