"""Random changes of input files, given to the commands: python -m tests.bars.fuzz [COUNT] [FIRST].

Each of COUNT changes ends with a documented exit code within 60 s, without a traceback; a refusal
says one sentence, and otherwise every file that appears can be read. What does not is printed, and
its folder is kept.
"""

import csv
import io
import json
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import tomllib
import traceback
import zipfile
from collections.abc import Callable
from pathlib import Path
from re import Match
from xml.etree import ElementTree

import cv2
import numpy as np
import pinocchio as pin

from recalib import load_arm
from recalib.laboratory.command_line import DONE, NO_BETTER, REFUSED, main
from tests.arms import INDUSTRIAL
from tests.identification.real import Real
from tests.laboratory.conftest import in_degrees, write
from tests.vision.rendering import Cell
from tests.vision.sessions import write_joints, write_session

SECONDS, PICTURES = 60, 11
CALIBRATE = ["calibrate", "arm.urdf", "rows.csv", "--description=it.toml"]
OBSERVE = ["observe", "pictures", "joints.csv", "--board=board.toml"]
VISUAL = (
    '<visual><origin xyz="0 0 0.1" rpy="0 0 0"/><geometry><box size="0.1 0.1 0.2"/></geometry>'
    '</visual><collision><geometry><sphere radius="0.05"/></geometry></collision></link>'
)
COMMANDS = {  # by the file that is changed: what reads it
    "arm.urdf": CALIBRATE,
    "rows.csv": CALIBRATE,
    "it.toml": CALIBRATE,
    "wanted.csv": ["correct", "calibration", "wanted.csv"],
    "calibration/correction.npz": ["correct", "calibration", "wanted.csv"],
    "links.csv": ["urdf", "links.csv"],
    "joints.csv": OBSERVE,
    "board.toml": OBSERVE,
    "pictures/001.png": OBSERVE,
    "lens.yaml": [*OBSERVE, "--lens=lens.yaml"],
    "observed/corners.csv": ["calibrate", "panda.urdf", "observed", "--tool=panda_link8"],
    "observed/setup.toml": ["calibrate", "panda.urdf", "observed", "--tool=panda_link8"],
    "observed/measurements.csv": ["calibrate", "panda.urdf", "observed", "--tool=panda_link8"],
}
NUMBERS = "nan inf -inf 1e308 -1e308 1e-320 0 -0 1e9 -1 1,5 0x10 1_000 ٣ 1e . - 9999999999999999999"
TEXTS = "true null ~ [] {} word \x00 \x01 \ufffe <x/> &a; ${a} =1+1 ../../x /dev/zero mm deg"
WORDS = [*NUMBERS.split(), *TEXTS.split(" "), "", " ", "\u2028", "\n", '"', "'", ";", 300 * "a"]


def prepare(folder: Path) -> None:
    """Write files that all commands take."""
    links = INDUSTRIAL.replace("</link>", VISUAL)
    (folder / "arm.urdf").write_text(links.replace('mass value="0.0"', 'mass value="2.0"'))
    arm = load_arm(folder / "arm.urdf")
    real = Real(arm, 0)
    joints = np.clip(real.postures(60), -1, 1)
    poses = real.poses(joints)
    known, wanted = poses[:25], poses[25:31]

    def columns(tool_poses: np.ndarray, angles: np.ndarray) -> dict[str, np.ndarray]:
        places = {f"{axis} [m]": tool_poses[:, i, 3] for i, axis in enumerate("xyz")}
        return in_degrees(arm, angles) | places

    write(folder / "rows.csv", columns(known, joints[:25]))
    write(folder / "wanted.csv", columns(wanted, joints[25:31]))
    place = ", ".join(f'"{x:.4f} m +- 5 mm"' for x in real.targets[0, :3, 3])
    (folder / "it.toml").write_text(f"[target]\nposition = [{place}]\n")
    rows = "".join(f"j{i},{100 * i},{90 * (i % 3 - 1)},{50 * i},0\n" for i in range(6))
    (folder / "links.csv").write_text("joint,a [mm],alpha [deg],d [mm],theta [deg]\n" + rows)
    cell = Cell(0)
    postures = cell.postures(PICTURES)
    (folder / "pictures").mkdir()
    for row, pose in enumerate(cell.board_poses(postures)):
        cv2.imwrite(str(folder / f"pictures/{row:03}.png"), cell.picture(pose))
    write_joints(folder / "joints.csv", cell, postures)
    (folder / "board.toml").write_text(cell.board.described())
    write_session(folder / "of", cell, pictures=14)
    (folder / "of/observed").rename(folder / "observed")
    shutil.copy(folder / "observed/lens.yaml", folder / "lens.yaml")
    assert run([*CALIBRATE, "--out=calibration"], folder)[0] == DONE
    for number, arguments in enumerate(COMMANDS.values()):
        code, lines = run([*arguments, f"--out=plain{number}"], folder)
        assert code == DONE, lines
    for plain in folder.glob("plain*"):
        shutil.rmtree(plain) if plain.is_dir() else plain.unlink()


def run(arguments: list[str], folder: Path) -> tuple[int, str]:
    """The exit code of a command in a process of its own, negative by a signal, and its lines."""
    with tempfile.TemporaryFile() as output:
        child = os.fork()
        if not child:
            os.chdir(folder)
            for stream in (1, 2):
                os.dup2(output.fileno(), stream)
            signal.alarm(SECONDS)
            code = 99
            try:
                code = main(arguments)
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else 98
            except BaseException:  # whatever it is, it is shown
                traceback.print_exc()
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(code)
        _, status = os.waitpid(child, 0)
        output.seek(0)
        return os.waitstatus_to_exitcode(status), output.read().decode(errors="replace")


Change = Callable[[random.Random, bytes], bytes]


def bytes_changed(rng: random.Random, content: bytes) -> bytes:
    """Bytes flipped, cut out, written twice, or the end left out."""
    at, size = rng.randrange(len(content)), rng.choice([1, 4, 40, 400])
    middle = content[at : at + size]
    replacements = {
        "flip": bytes(byte ^ 1 << rng.randrange(8) for byte in middle[:3]) + middle[3:],
        "cut": b"",
        "twice": 2 * middle,
        "noise": rng.randbytes(size),
    }
    if rng.random() < 0.2:
        return content[:at]
    return content[:at] + replacements[rng.choice([*replacements])] + content[at + size :]


def words_changed(rng: random.Random, content: bytes) -> bytes:
    """Numbers or words replaced by another one."""
    text = content.decode(errors="surrogateescape")
    matches = [*re.finditer(r"[-+.\w]+", text)]
    word = rng.choice(WORDS)
    for match in sorted(rng.choices(matches, k=rng.choice([1, 1, 1, 3])), key=Match.start)[::-1]:
        text = text[: match.start()] + word + text[match.end() :]
    return text.encode(errors="surrogateescape")


def lines_changed(rng: random.Random, content: bytes) -> bytes:
    """Lines, or tags, left out, twice, exchanged or mixed; a column with one number; a BOM."""
    parts = re.split(rb"(?<=>)|(?<=\n)", content)
    source, target = rng.randrange(len(parts)), rng.randrange(len(parts))
    match rng.randrange(7):
        case 0:
            parts.pop(source)
        case 1:
            parts.insert(target, parts[source])
        case 2:
            parts[source], parts[target] = parts[target], parts[source]
        case 3:
            rng.shuffle(parts)
        case 4:
            parts = parts[:2]
        case 5:
            parts = [part.replace(b"\n", b"\r\n") for part in [b"\xef\xbb\xbf", *parts]]
        case 6:
            word, column = rng.choice(WORDS).encode(), rng.randrange(8)
            cells = [part.split(b",") for part in parts]
            for row in cells[1:]:
                if column < len(row) - 1:
                    row[column] = word
            parts = [b",".join(row) for row in cells]
    return b"".join(parts)


def picture_changed(rng: random.Random, content: bytes) -> bytes:
    """A picture of another size, kind or exposure."""
    picture = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_GRAYSCALE)
    height, width = picture.shape
    candidates = [
        picture[:1, :1],
        picture[:1],
        picture[:, :1],
        picture[::-1],
        picture[: height // 2],
        np.zeros_like(picture),
        picture.astype(np.uint16) * 257,
        cv2.cvtColor(picture, cv2.COLOR_GRAY2BGRA),
        cv2.resize(picture, (2 * width, height)),
        cv2.resize(picture, (3 * width, 3 * height)),
        rng.randbytes(picture.size),
    ]
    changed = rng.choice(candidates)
    if isinstance(changed, bytes):
        changed = np.frombuffer(changed, np.uint8).reshape(picture.shape)
    return cv2.imencode(rng.choice([".png", ".jpg", ".tiff", ".bmp"]), changed)[1].tobytes()


def archive_changed(rng: random.Random, content: bytes) -> bytes:
    """A member of an archive changed, left out or named otherwise."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(buffer, "w") as new:
        names = old.namelist()
        changed = rng.choice(names)
        for name in names:
            member = old.read(name)
            if name == changed:
                match rng.randrange(4):
                    case 0:
                        continue
                    case 1:
                        name = "other.npy"
                    case 2:
                        member = bytes_changed(rng, member)
                    case 3:
                        member = old.read(rng.choice(names))
            new.writestr(name, member)
    return buffer.getvalue()


def changes(name: str) -> list[Change]:
    """The kinds of changes of a file."""
    kinds = {".png": [picture_changed, bytes_changed], ".npz": [archive_changed, bytes_changed]}
    return kinds.get(Path(name).suffix, [*2 * [words_changed], lines_changed, bytes_changed])


def unreadable(out: Path) -> str | None:
    """The file of what was written that cannot be read, and why."""
    paths = [*out.rglob("*")] if out.is_dir() else [out]
    for path in [path for path in paths if path.is_file()]:
        try:
            content = path.read_bytes()
            match path.suffix:
                case ".urdf":
                    ElementTree.fromstring(content)
                    pin.buildModelFromUrdf(str(path))
                case ".svg":
                    ElementTree.fromstring(content)
                case ".json":
                    json.loads(content, parse_constant=lambda word: 1 / 0)
                case ".toml":
                    tomllib.loads(content.decode())
                case ".csv":
                    widths = {len(row) for row in csv.reader(io.StringIO(content.decode()))}
                    assert len(widths) == 1 and not re.search(rb"\b(nan|inf)\b", content)
                case ".npz":
                    with np.load(path) as file:
                        {member: file[member] for member in file.files}
                case _:
                    content.decode()
        except Exception as error:
            return f"{path.name}: {type(error).__name__} {error}"
    return None


def wrong(code: int, lines: str, out: Path) -> str | None:
    """What is wrong with an end, if anything is."""
    if "Traceback" in lines or code not in (DONE, NO_BETTER, REFUSED):
        return "hangs" if code == -signal.SIGALRM else f"exit code {code}"
    if code == REFUSED:
        last = lines.splitlines()[-1]
        if not last.startswith("recalib: ") or len(last) > 600 or not last.isprintable():
            return "no sentence"
        return "something was written" if out.exists() else None
    return unreadable(out)


def fuzz(count: int, first: int) -> int:
    """How many of so many changes end badly; each of these is printed."""
    parent, names, failures = Path(tempfile.mkdtemp(prefix="fuzz-")), [*COMMANDS], 0
    base = parent / "base"
    base.mkdir()
    prepare(base)
    codes: dict[int, int] = {}
    for seed in range(first, first + count):
        rng, name = random.Random(seed), names[seed % len(names)]
        folder = parent / str(seed)
        shutil.copytree(base, folder)
        path = folder / name
        change = rng.choice(changes(name))
        path.write_bytes(change(rng, path.read_bytes()))
        code, lines = run([*COMMANDS[name], "--out=out"], folder)
        codes[code] = codes.get(code, 0) + 1
        out = next(folder.glob("out*"), folder / "out")
        if reason := wrong(code, lines, out):
            failures += 1
            print(f"{seed}: {name}, {change.__name__}: {reason}: {folder}", lines[-600:], sep="\n")
        else:
            shutil.rmtree(folder)
    print(f"{failures} of {count} end badly; exit codes: {codes}")
    return failures


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    sys.exit(bool(fuzz(*numbers, *[300, 0][len(numbers) :])))
