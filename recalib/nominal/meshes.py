"""The mesh files of a URDF, restricted to its own packages and folders."""

import os
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from recalib.nominal.descriptions import parsed

KINDS = ".dae", ".glb", ".gltf", ".obj", ".stl"
MOST = 100_000_000  # bytes of one
PACKAGE = "package://"


def with_own_meshes(
    source: bytes, urdf: Path, role: str = "visual", other: str = "collision"
) -> tuple[bytes, list[str]]:
    """A URDF with only the shapes of one role, and with absolute paths of meshes.

    A URDF can name any file, so files elsewhere are left out for safety, and so are textures.

    Args:
        source: the content of the URDF at `urdf`.
        role, other: the roles of shapes to retain and to remove.

    Returns the URDF in UTF-8, and the names of the meshes that were left out.
    """
    robot, left_out = parsed(source, urdf), []
    for link in robot.iter("link"):
        for shape in link.findall(other):
            link.remove(shape)
        for shape in link.findall(role):
            if (mesh := shape.find("geometry/mesh")) is None:
                continue
            name = mesh.get("filename", "")
            if file := _find(name, urdf.resolve()):
                mesh.set("filename", str(file))
            else:
                link.remove(shape)
                left_out.append(name)
    for material in robot.iter("material"):
        for texture in material.findall("texture"):
            material.remove(texture)
    return ElementTree.tostring(robot, encoding="utf-8"), left_out


def mesh_files(urdf: Path) -> list[Path]:
    """The files of all visual meshes, in the order of the URDF."""
    meshes = parsed(urdf.read_bytes(), urdf).iterfind(".//visual//mesh")
    names = dict.fromkeys(mesh.get("filename", "") for mesh in meshes)
    return [file for name in names if (file := _find(name, urdf.resolve()))]


def _find(name: str, urdf: Path) -> Path | None:
    """The file of a mesh; None if, with symbolic links resolved, it is in no permitted folder."""
    package, _, path = name.removeprefix(PACKAGE).lstrip("/").partition("/")
    if name.startswith(PACKAGE):
        places = [(folder, folder / path) for folder in _packages(package, urdf)]
    else:  # in the URDF's package, or in its folder if there is none
        home = next((folder for folder in urdf.parents if _is_package(folder)), urdf.parent)
        places = [(home, urdf.parent / name.removeprefix("file://"))]
    try:
        for folder, place in places:
            file = place.resolve()
            inside = file.is_relative_to(folder.resolve()) and file.suffix.lower() in KINDS
            if inside and file.is_file() and file.stat().st_size <= MOST:
                return file
    except (OSError, RuntimeError):  # an impossible file name, or a loop of symbolic links
        pass
    return None


def _packages(name: str, urdf: Path) -> Iterator[Path]:
    """Possible folders of a package: around the URDF, next to it, and in ROS's search paths."""
    if name in ("", ".", ".."):
        return
    for folder in urdf.parents:
        if folder.name == name and (_is_package(folder) or folder in urdf.parents[:2]):
            yield folder
        if folder == urdf.parent or _is_package(folder / name):
            yield folder / name
    for folder in map(Path, filter(None, os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep))):
        yield folder if folder.name == name else folder / name
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(prefix, "share", name)


def _is_package(folder: Path) -> bool:
    return (folder / "package.xml").is_file()
