"""The shapes of an arm's links, by which it may touch itself or the floor."""

from os import PathLike
from xml.etree import ElementTree

import pinocchio as pin

from recalib.errors import check_kind
from recalib.files.storage import read_file
from recalib.nominal.descriptions import MOST, caught_messages, find_urdf, parsed
from recalib.nominal.kinematics import Arm
from recalib.nominal.meshes import with_own_meshes


def load_shapes(arm: Arm, urdf: str | PathLike[str]) -> tuple[pin.GeometryModel, list[str]]:
    """The collision shapes in a URDF, each carried by the joint of `arm` that carries its link.

    Args:
        arm: from this URDF.
        urdf: see `find_urdf`.

    Returns them, and the names of shapes that cannot be read: mesh files, or links. Raises
    InvalidSetting: something else than an arm.
    """
    check_kind("arm", arm, Arm)
    path = find_urdf(urdf)
    source, missing = with_own_meshes(read_file(path, MOST), path, "collision", "visual")
    shapes = pin.GeometryModel()
    for link in parsed(source, path).iterfind("link"):
        name = link.attrib["name"]
        frame = arm.model.getFrameId(name, pin.FrameType.BODY)
        if frame == len(arm.model.frames):  # it hangs on nothing
            continue
        carrier = arm.model.frames[frame]
        for collision in link.findall("collision"):
            try:
                placed = _shapes_of(collision)
            except (ValueError, RuntimeError):
                missing.append(name)
                continue
            for shape in placed:
                place = carrier.placement * shape.placement
                shapes.addGeometryObject(
                    pin.GeometryObject(name, carrier.parentJoint, frame, place, shape.geometry)
                )
    return shapes, missing


def _shapes_of(collision: ElementTree.Element) -> list[pin.GeometryObject]:
    """The shapes of one collision element, placed in its link. Raises ValueError, RuntimeError."""
    robot = ElementTree.Element("robot", name="robot")
    ElementTree.SubElement(robot, "link", name="link").append(collision)
    text = ElementTree.tostring(robot, encoding="unicode")
    with caught_messages():
        model = pin.buildModelFromXML(text)
        return [*pin.buildGeomFromUrdfString(model, text, pin.COLLISION).geometryObjects]
