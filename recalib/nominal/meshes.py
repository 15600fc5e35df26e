"""The files of the meshes that a URDF draws its links with."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

PACKAGE = "package://"


def mesh_files(urdf: Path) -> list[Path]:
    """The files of all visual meshes, as far as they are there, in the order of the URDF.

    `package://NAME/...` is looked for where `recalib.viewing` has it looked for: NAME is a folder
    beside or above the URDF.
    """
    meshes = ElementTree.parse(urdf).getroot().iterfind(".//visual//mesh")
    names = dict.fromkeys(mesh.get("filename", "") for mesh in meshes)
    found = (next(filter(Path.is_file, _places(urdf, name)), None) for name in names)
    return [path for path in found if path]


def _places(urdf: Path, name: str) -> Iterator[Path]:
    if name.startswith(PACKAGE):
        yield from (folder / name.removeprefix(PACKAGE) for folder in urdf.resolve().parents)
    else:
        yield urdf.parent / name.removeprefix("file://")
