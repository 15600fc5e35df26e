"""URDF files: finding them, reading them, and reporting mistakes in them."""

import hashlib
import importlib
import importlib.metadata
import math
import os
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from xml.etree.ElementTree import Element

from recalib.errors import InvalidFile, InvalidSetting, UnknownName, UnsuitableRobot
from recalib.files.storage import path_of, read_file, read_xml

DATA = "example-robot-data"
FETCHED = "robot_descriptions"  # the package robot_descriptions.py, which downloads and caches them
MOST = 16_000_000  # bytes
MOST_JOINTS = 1000  # Pinocchio recurses over joints: more may overflow its stack
MOVING = "revolute", "continuous", "prismatic"  # joints
SHORTEST = 1e-6  # length of an axis: Pinocchio may not normalise a shorter one
MOST_TURN = 4 * math.pi  # rad in an origin: a larger number must be in degrees
NUMBERS = {  # numeric attributes of joints and inertials, by element
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "limit": ("lower", "upper"),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "mimic": ("multiplier", "offset"),
}
ERROR = "Error:"  # start of urdfdom's messages about mistakes
STDERR = 2  # file descriptor, shared by the whole process
_ONE = threading.Lock()  # only one block at a time may redirect stderr


def find_urdf(urdf: str | PathLike[str]) -> Path:
    """The file of a URDF. The user's own files take precedence over files of packages.

    `urdf` is a path; the name of a file in example-robot-data, such as ur10_robot.urdf; or the name
    of a description in robot_descriptions.py, such as panda_description, if that is installed.

    Raises UnknownName, or InvalidFile if it is a path.
    """
    return _found(urdf)[0]


def _found(urdf: str | PathLike[str]) -> tuple[Path, str | None]:
    """The file of a URDF, and the package that contains it; None for a path."""
    path, name = path_of(urdf), fspath(urdf)
    if os.path.lexists(path) and not os.path.isdir(path):
        return path, None
    if name in _packaged_urdfs():
        return _packaged_urdfs()[name], DATA
    if name.endswith("_description") and name.isidentifier():
        try:
            return Path(importlib.import_module(f"{FETCHED}.{name}").URDF_PATH), FETCHED
        except (ImportError, AttributeError):
            valid = f"a path, or a URDF of {FETCHED}, which has to be installed"
            raise InvalidSetting("urdf", name, valid) from None
    if os.path.isdir(path):
        raise InvalidFile(urdf, "it is a folder; expected: a file")
    if path.name != name:
        raise InvalidFile(urdf, "there is no such file")
    known = {*_packaged_urdfs(), *(file.name for file in Path.cwd().glob("*.urdf"))}
    raise UnknownName("file or URDF of example-robot-data", name, known)


@cache
def _packaged_urdfs() -> dict[str, Path]:
    files = importlib.metadata.files(DATA) or []
    return {file.name: Path(file.locate()) for file in files if file.suffix == ".urdf"}


@dataclass(frozen=True)
class UrdfFile:
    """The URDF of an arm.

    Attributes:
        path: path of the file.
        content: its bytes.
        origin: its name, its package if it has one, and its digest, as text.
    """

    path: Path
    content: bytes
    origin: str

    @classmethod
    def read(cls, urdf: str | PathLike[str]) -> "UrdfFile":
        """Read a URDF by path or name. Raises like `find_urdf`, and InvalidFile."""
        path, package = _found(urdf)
        content = read_file(path, MOST)
        name = f"{path.name} of the package {package}" if package else fspath(urdf)
        return cls(path, content, f"{name} (sha256 {hashlib.sha256(content).hexdigest()[:12]})")


def parsed(source: bytes, path: Path) -> Element:
    """The root element of a URDF; `path` is only for messages.

    Raises UnsuitableRobot if it is not XML, not in its declared encoding, or has too many joints.
    """
    try:
        robot = read_xml(source, path)
    except InvalidFile as error:
        raise UnsuitableRobot(f"{path} is not a URDF: {error.reason}") from None
    root = robot.tag
    for element in robot.iter() if "}" in root else ():
        element.tag = local_name(element.tag, root)
    if (count := len(robot.findall("joint"))) > MOST_JOINTS:
        raise UnsuitableRobot(f"{path} has {count} joints; expected: at most {MOST_JOINTS}")
    return robot


def local_name(name: str, root: str) -> str:
    """An element's name without the root's namespace, which is written as `{http://...}joint`."""
    return name.removeprefix(root[: root.rfind("}") + 1])


def link_of(joint: Element, role: str) -> str:
    """Name of the parent or child link of a joint that Pinocchio has accepted."""
    return joint.findall(role)[0].attrib["link"]


@contextmanager
def caught_messages() -> Iterator[list[str]]:
    """Capture the lines that a block writes to stderr; the list is filled when the block ends.

    Commands report a mistake in one sentence. A compiled library's messages to its developers would
    hide it, and bypass Python's `sys.stderr`.
    """
    lines: list[str] = []
    with _ONE, tempfile.TemporaryFile() as file:
        try:
            before = os.dup(STDERR)
        except OSError:  # stderr is closed, so nothing can be written to it
            yield lines
            return
        os.dup2(file.fileno(), STDERR)
        try:
            yield lines
        finally:
            os.dup2(before, STDERR)
            os.close(before)
            file.seek(0)
            lines += file.read().decode(errors="replace").splitlines()


def check_description(robot: Element, path: Path) -> None:
    """Raise UnsuitableRobot unless links form a tree, and joints and masses have finite numbers.

    Names of links and joints must be printable, for messages and tables.
    """
    carried: dict[str, str] = {}
    named: set[tuple[str, str]] = set()
    for part in (*robot.iterfind("link"), *robot.iterfind("joint")):
        if not (name := part.get("name", "-")).strip() or not name.isprintable():
            raise UnsuitableRobot(
                f"a {part.tag} in {path} has the name {part.get('name')!r}; expected: letters that"
                " can be printed"
            )
        if (part.tag, name) in named and "name" in part.attrib:
            raise UnsuitableRobot(f"{path} has two {part.tag}s {name}; expected: a name for each")
        named.add((part.tag, name))
    for joint in robot.iterfind("joint"):
        child, name = joint.find("child"), joint.get("name", "")
        link = "" if child is None else child.get("link", "")
        if link in carried:
            raise UnsuitableRobot(
                f"{link} is the child of two joints, {carried[link]} and {name}, in {path}: a"
                " closed chain; expected: a tree"
            )
        carried |= {link: name} if link else {}
    for part in robot:
        for element in (inner for place in (part, *part.findall("inertial")) for inner in place):
            for key in NUMBERS.get(element.tag, ()):
                numbers, text = _numbers(element.get(key, "0")), element.get(key)
                found = f"the {element.tag} of {part.get('name')} in {path} has {key} {text!r}"
                if not numbers:
                    raise UnsuitableRobot(f"{found}; expected: a number")
                if key == "rpy" and max(map(abs, numbers)) > MOST_TURN:
                    raise UnsuitableRobot(f"{found}; expected: rad, not degrees")
                axis = element.tag == "axis" and part.get("type") in MOVING
                if axis and not SHORTEST < max(map(abs, numbers)) < 1 / SHORTEST:
                    reason = f"the axis of {part.get('name')} has no length"
                    raise UnsuitableRobot(f"{reason} in {path}")


def mistakes(robot: Element, messages: list[str]) -> Iterator[str]:
    """Mistakes in a URDF: vectors of wrong length first, then urdfdom's messages."""
    for part in robot:
        vectors = ((inner, key, inner.get(key)) for inner in part.iter() for key in ("xyz", "rpy"))
        for element, key, text in vectors:
            if text is not None and len(_numbers(text) or ()) != 3:
                where = f"the {element.tag} of {part.get('name')}"
                yield f"{where} has {key} {text!r}; expected: three numbers"
    for line in messages:
        if line.startswith(ERROR):
            yield line.removeprefix(ERROR).strip().rstrip(".")


def _numbers(text: str) -> list[float] | None:
    """The numbers in a text; None if it contains anything but finite numbers."""
    try:
        numbers = [float(number) for number in text.split()]
    except ValueError:
        return None
    return numbers if all(map(math.isfinite, numbers)) else None
