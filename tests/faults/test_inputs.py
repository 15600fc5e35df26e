"""Endless, huge and nested inputs: each ends in one sentence, soon, in little memory."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

from recalib.laboratory.command_line import REFUSED, main
from tests.conftest import ROOT
from tests.laboratory.conftest import ARM

SECONDS, BYTES = 10, 1e9
MEMORY = "memory"
END = "</robot>"
HEAD = ARM.removesuffix(END)
DEEP = 200_000
ROW = "0,-40,60,1,2,3\n"
TABLE = "swing [deg],lift [deg],elbow [deg],x [mm],y [mm],z [mm]\n" + 12 * ROW


def fixed(count: int) -> str:
    links = (
        f'<link name="f{i}"/><joint name="j{i}" type="fixed"><parent link="'
        f'{f"f{i - 1}" if i else "link_4"}"/><child link="f{i}"/></joint>'
        for i in range(count)
    )
    return HEAD + "".join(links) + END


def deep(tag: str) -> str:
    return f"<{tag}>" * DEEP + f"</{tag}>" * DEEP


def pipe(path: Path) -> None:
    os.mkfifo(path)


def endless(path: Path) -> None:
    path.symlink_to("/dev/zero")


def packed(path: Path) -> None:
    file = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
    with file, file.open("header.npy", "w", force_zip64=True) as member:
        for _ in range(200):
            member.write(bytes(10_000_000))


# By what is wrong: the file, what makes it or stands in it, and what the sentence has.
WRONG = {
    "a URDF that is a pipe": ("arm.urdf", pipe, "it is a pipe; expected: a regular file"),
    "a URDF without an end": ("arm.urdf", endless, "it is a device; expected: a regular"),
    "a comment of 60 MB": (
        "arm.urdf",
        lambda path: path.write_text(f"{HEAD}<!--{60_000_000 * 'x'}-->{END}"),
        "it has 60 MB; expected: at most 16 MB",
    ),
    "deep XML": ("arm.urdf", HEAD + deep("a") + END, "is not a URDF that Pinocchio can read"),
    "a place far away": (
        "arm.urdf",
        ARM.replace("0.05 0 0.1", "1e308 0 0.1"),
        "lift is 50 m or more from what carries it",
    ),
    "a heavy link": ("arm.urdf", ARM.replace('"0.0"', '"1e308"'), "has no mass of an arm's link"),
    "4000 fixed joints": ("arm.urdf", fixed(4000), "has 4004 joints; expected: at most 1000"),
    "another encoding than it says": (
        "arm.urdf",
        f'<?xml version="1.0" encoding="x-none"?>{ARM}',
        "its text is not in x-none",
    ),
    "a table that is a pipe": ("rows.csv", pipe, "it is a pipe; expected: a regular file"),
    "a million rows": (
        "rows.csv",
        lambda path: path.write_text(TABLE + 1_000_000 * ROW),
        "it has more than 10000 rows; try: every tenth of them",
    ),
    "one row of 60 MB": (
        "rows.csv",
        lambda path: path.write_text(TABLE + 30_000_000 * "1,"),
        "it has 60 MB; expected: at most 32 MB",
    ),
    "a heading of many columns": ("rows.csv", 15_000_000 * "," + "\n", "it is empty"),
    "a cell of many digits": ("rows.csv", TABLE + 10_000_000 * "1" + ROW, "it is not CSV"),
    "a description without an end": ("it.toml", endless, "it is a device; expected: a regular"),
    "deep TOML": ("it.toml", "a = " + 7_000 * "[" + 7_000 * "]", "nested too deeply"),
    "deep keys": ("it.toml", "instrument." + 7_900 * "a." + "a = 1", "nested too deeply"),
    "a long description": ("it.toml", 100_000 * "[", "at most 0.016 MB"),
    "a number of many digits": ("it.toml", "a = " + 10_000 * "9", "it is not TOML"),
    "an instrument far away": (
        "it.toml",
        '[instrument]\nposition = ["1e300 m", "0 m", "0 m"]',
        "instrument.position is '1e300 m'; expected: up to 10 m",
    ),
    "a correction without an end": ("correction.npz", endless, "it is a device"),
    "a correction that is packed": (
        "correction.npz",
        packed,
        "it unpacks to 2e+03 MB; expected: at most 256",
    ),
}


def prepare(folder: Path, name: str, make) -> None:
    folder.mkdir()
    for file, text in (("arm.urdf", ARM), ("rows.csv", TABLE), ("it.toml", "")):
        if file != name:
            (folder / file).write_text(text)
    if callable(make):
        make(folder / name)
    else:
        (folder / name).write_text(make)


def run_all(folder: str) -> None:
    """Run the commands one after the other, and print how long each computed."""
    for number, (name, *_) in enumerate(WRONG.values()):
        os.chdir(Path(folder, str(number)))
        start = time.process_time()
        calibrate = ["calibrate", "./arm.urdf", "rows.csv", "--description=it.toml"]
        code = main([*(["next", "."] if name == "correction.npz" else calibrate), "--out=out"])
        print(json.dumps([code, time.process_time() - start]), flush=True)
        print("END", file=sys.stderr, flush=True)
    print(re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())[1])


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Exit code, seconds and lines of the command, by wrong input; and the memory of all [kB]."""
    folder = tmp_path_factory.mktemp("inputs")
    for number, (name, make, _) in enumerate(WRONG.values()):
        prepare(folder / str(number), name, make)
    text = f"from tests.faults import test_inputs; test_inputs.run_all({str(folder)!r})"
    process = subprocess.run(
        [sys.executable, "-c", text], cwd=ROOT, text=True, capture_output=True, timeout=600
    )
    shutil.rmtree(folder)
    codes = map(json.loads, process.stdout.splitlines())
    reports = zip(codes, process.stderr.split("END\n"), strict=False)
    return dict(zip([*WRONG, MEMORY], reports, strict=False))


@pytest.mark.parametrize("wrong", WRONG)
def test_it_ends_in_a_sentence_and_soon(wrong, outcomes):
    assert wrong in outcomes, "its command was not reached"
    (code, seconds), lines = outcomes[wrong]
    assert code == REFUSED and seconds < SECONDS
    last = lines.splitlines()[-1]
    assert last.startswith("recalib: ") and WRONG[wrong][2] in last and len(last) < 500
    assert "Traceback" not in lines


def test_all_of_it_takes_little_memory(outcomes):
    assert 1024 * outcomes[MEMORY][0] < BYTES
