"""Files that describe robots (URDF): where they are, what they are called, and what they say."""

import hashlib
import importlib
import importlib.metadata
import os
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from xml.etree import ElementTree

from recalib.errors import InvalidFile, InvalidSetting, UnknownName, UnsuitableRobot
from recalib.files.storage import path_of, read_file
from recalib.files.xml import read_xml

DATA = "example-robot-data"
FETCHED = "robot_descriptions"  # of robot_descriptions.py, which fetches and keeps them
MOST = 16_000_000  # bytes
MOST_JOINTS = 1000  # Pinocchio takes one after the other by recursion, on a stack that ends


def find_urdf(urdf: str | PathLike[str]) -> Path:
    """The file of a URDF. One of the user's own comes before one of a package.

    Args:
        urdf: a path; the name of a file of example-robot-data, such as ur10_robot.urdf; or that of
            a description in robot_descriptions.py, such as panda_description, if it is installed.

    Raises UnknownName, or InvalidFile if it is a path and not a name.
    """
    package = package_of(urdf)
    if package is None:
        return Path(urdf)
    if package == DATA:
        return _packaged_urdfs()[fspath(urdf)]
    try:
        return Path(importlib.import_module(f"{FETCHED}.{fspath(urdf)}").URDF_PATH)
    except (ImportError, AttributeError):
        valid = f"a path, or a URDF of {FETCHED}, which has to be installed"
        raise InvalidSetting("urdf", fspath(urdf), valid) from None


def package_of(urdf: str | PathLike[str]) -> str | None:
    """The package that a name is of; None for a path to a file. Raises as `find_urdf`."""
    path, name = path_of(urdf), fspath(urdf)
    if os.path.lexists(path) and not os.path.isdir(path):
        return None
    if name in _packaged_urdfs():
        return DATA
    if name.endswith("_description") and name.isidentifier():
        return FETCHED
    if os.path.isdir(path):
        raise InvalidFile(urdf, "it is a folder; expected: a file")
    if path.name != name:
        raise InvalidFile(urdf, "there is no such file")
    valid = {*_packaged_urdfs(), *(file.name for file in Path.cwd().glob("*.urdf"))}
    raise UnknownName("file or URDF of example-robot-data", name, valid)


@cache
def _packaged_urdfs() -> dict[str, Path]:
    files = importlib.metadata.files(DATA) or []
    return {file.name: Path(file.locate()) for file in files if file.suffix == ".urdf"}


@dataclass(frozen=True)
class UrdfFile:
    """The URDF of an arm.

    Attributes:
        path: of the file.
        content: its bytes.
        origin: for people: its name, its package if it is of one, and its digest.
    """

    path: Path
    content: bytes
    origin: str

    @classmethod
    def read(cls, urdf: str | PathLike[str]) -> "UrdfFile":
        """The file that a path or a name means. Raises as `find_urdf`, and InvalidFile."""
        path, package = find_urdf(urdf), package_of(urdf)
        content = read_file(path, MOST)
        name = f"{path.name} of the package {package}" if package else fspath(urdf)
        return cls(path, content, f"{name} (sha256 {hashlib.sha256(content).hexdigest()[:12]})")


def parsed(source: bytes, path: Path) -> ElementTree.Element:
    """The root of a URDF.

    Args:
        path: of the file, for messages.

    Raises UnsuitableRobot: not XML, in another encoding than it declares, or of too many joints.
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
    """An element's name without its namespace, if that is the root's: `http://...}joint`."""
    return name.removeprefix(root[: root.rfind("}") + 1])


def link_of(joint: ElementTree.Element, role: str) -> str:
    """Name of the parent or child link of a joint that Pinocchio has accepted."""
    return joint.findall(role)[0].attrib["link"]
