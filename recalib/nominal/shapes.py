"""The collision shapes of an arm's links."""

from os import PathLike
from xml.etree import ElementTree

import pinocchio as pin

from recalib.errors import check_kind
from recalib.files.storage import read_file
from recalib.nominal.descriptions import MOST, caught_messages, find_urdf, parsed
from recalib.nominal.kinematics import Arm
from recalib.nominal.meshes import with_own_meshes


def load_shapes(arm: Arm, urdf: str | PathLike[str]) -> tuple[pin.GeometryModel, list[str]]:
    """The collision shapes in a URDF, each attached to the joint of `arm` that carries its link.

    Args:
        arm: an arm from this URDF.
        urdf: see `find_urdf`.

    Returns the shapes, and the names of mesh files or links whose shapes cannot be read. Raises
    InvalidSetting for anything else than an arm.
    """
    check_kind("arm", arm, Arm)
    path = find_urdf(urdf)
    source, missing = with_own_meshes(read_file(path, MOST), path, "collision", "visual")
    shapes = pin.GeometryModel()
    for link in parsed(source, path).iterfind("link"):
        name = link.attrib["name"]
        frame = arm.model.getFrameId(name, pin.FrameType.BODY)
        if frame == len(arm.model.frames):  # no root carries this link
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
    """The shapes of one collision element, in its link's frame. Raises ValueError, RuntimeError."""
    robot = ElementTree.Element("robot", name="robot")
    ElementTree.SubElement(robot, "link", name="link").append(collision)
    text = ElementTree.tostring(robot, encoding="unicode")
    with caught_messages():
        model = pin.buildModelFromXML(text)
        return [*pin.buildGeomFromUrdfString(model, text, pin.COLLISION).geometryObjects]
