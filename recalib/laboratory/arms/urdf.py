"""The user's own URDF with other origins: every other byte of the file stays as it was.

A calibration moves placements by twists and joints by offsets. Both go into the origins of joints:
turning a joint's frame about its own axis is what its offset does. Where the tool link hangs on a
moving joint directly, no origin is left to move it by: it gets a link of its own behind it.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib.identification.calibration import Calibration
from recalib.nominal.descriptions import encoding, link_of, parsed
from recalib.nominal.kinematics import Arm, tool_frame

CORRECTED = "_corrected"  # what a further link for the tool is called, after the tool's own name
_TAG = re.compile(rb"<(?:[^>\"']|\"[^\"]*\"|'[^']*')*>")


def corrected_urdf(source: bytes, calibration: Calibration) -> tuple[bytes, str]:
    """The URDF of the nominal arm with what the calibration says of its geometry.

    Args:
        source: the file from which the nominal arm was read.

    Returns the new file, and the name of the link that is the tool there.
    """
    nominal = calibration.model.nominal
    origins, tool = corrected_origins(source, calibration)
    if tool is None:
        return with_origins(source, origins), nominal.tool
    name = nominal.tool + CORRECTED
    added = (
        f'  <link name="{name}"/>\n  <joint name="{name}" type="fixed">\n'
        f'    <parent link="{nominal.tool}"/>\n    <child link="{name}"/>\n'
        f"    {_origin(tool)}\n  </joint>\n"
    )
    return with_origins(source, origins, added), name


def corrected_origins(
    source: bytes, calibration: Calibration
) -> tuple[dict[str, np.ndarray], np.ndarray | None]:
    """New origins (4, 4) by joint, and that of a further link for the tool, if it needs one."""
    nominal, parameters = calibration.model.nominal, calibration.estimate.parameters
    arm, offsets = calibration.model.own_arm(parameters), offset_poses(calibration)
    moving, (fixed, name) = _segments(source, nominal)
    origins = {}
    for joint, (before, its) in enumerate(moving, start=1):
        placement = arm.model.jointPlacements[joint].homogeneous
        origins[its] = np.linalg.inv(before) @ placement @ offsets[joint - 1]
    tool = arm.model.frames[tool_frame(arm.model, arm.tool)].placement.homogeneous
    if name is None:
        return origins, tool
    return origins | {name: np.linalg.inv(fixed) @ tool}, None


def with_origins(source: bytes, origins: Mapping[str, np.ndarray], added: str = "") -> bytes:
    """A URDF with other origins (4, 4) [m] for the named joints; nothing else is touched.

    Args:
        added: what is to stand at its end.
    """
    its = encoding(source)
    text = source.decode(its).encode("utf-8")
    spans, last = _origin_spans(text)
    pieces, done = [], 0
    for joint in sorted(origins, key=lambda joint: spans[joint]):
        start, end = spans[joint]
        new = _origin(origins[joint])
        pieces += [text[done:start], (new if start < end else f"\n    {new}").encode()]
        done = end
    changed = b"".join([*pieces, text[done:last], added.encode("utf-8"), text[last:]])
    return changed.decode("utf-8").encode(its)


def _origin(pose: np.ndarray) -> str:
    return f'<origin xyz="{written(pose[:3, 3])}" rpy="{written(angles_of(pose))}"/>'


def written(vector: np.ndarray) -> str:
    """Numbers (n,) as a URDF has them; they read as what they were."""
    return " ".join(f"{number + 0.0:.17g}" for number in vector)


def offset_poses(calibration: Calibration) -> list[np.ndarray]:
    """For each joint, how its offset moves its own frame, (4, 4)."""
    arm = calibration.model.nominal
    offsets = calibration.model.coefficients(calibration.estimate.parameters)["offset"]
    moves = arm.axes * offsets[:, None]
    poses = [np.eye(4) for _ in arm.joints]
    for pose, move, slides in zip(poses, moves, arm.slides, strict=True):
        if slides:
            pose[:3, 3] = move
        else:
            pose[:3, :3] = Rotation.from_rotvec(move).as_matrix()
    return poses


def angles_of(pose: np.ndarray) -> np.ndarray:
    """Roll, pitch and yaw (3,) [rad] of a pose (4, 4), which give it back even at a pitch of 90.

    Each angle is taken from what the ones before it leave.
    """
    turn = pose[:3, :3]
    roll = np.arctan2(turn[2, 1], turn[2, 2])
    rest = turn @ pin.rpy.rpyToMatrix(roll, 0.0, 0.0).T
    return np.array(
        [roll, np.arctan2(-rest[2, 0], rest[2, 2]), np.arctan2(-rest[0, 1], rest[1, 1])]
    )


def _segments(
    source: bytes, arm: Arm
) -> tuple[list[tuple[np.ndarray, str]], tuple[np.ndarray, str | None]]:
    """For each moving joint, and for the tool: the joint whose origin places it, and the origins
    (4, 4) of the fixed joints before that one. The tool may have no such joint.
    """
    joints = parsed(source, Path("arm.urdf")).findall("joint")
    by_child = {link_of(joint, "child"): joint for joint in joints}
    path, link = [], arm.tool
    while link in by_child and link != arm.base:
        path.append(by_child[link])
        link = link_of(path[-1], "parent")
    moving, fixed = [], np.eye(4)
    last: tuple[np.ndarray, str | None] = fixed, None
    for joint in reversed(path):
        name = joint.attrib["name"]
        if name in arm.joints:
            moving.append((fixed, name))
            fixed = np.eye(4)
            last = fixed, None
        else:
            last = fixed, name
            fixed = fixed @ _pose(joint.find("origin"))
    return moving, last


def _pose(origin: ElementTree.Element | None) -> np.ndarray:
    pose = np.eye(4)
    if origin is not None:
        x, y, z = map(float, origin.get("xyz", "0 0 0").split())
        roll, pitch, yaw = map(float, origin.get("rpy", "0 0 0").split())
        pose[:3, 3], pose[:3, :3] = (x, y, z), pin.rpy.rpyToMatrix(roll, pitch, yaw)
    return pose


def _origin_spans(text: bytes) -> tuple[dict[str, tuple[int, int]], int]:
    """First and last byte of each joint's origin, or of where it would stand; and the root's last.

    Args:
        text: in UTF-8, whatever it says of itself.
    """
    spans: dict[str, tuple[int, int]] = {}
    path: list[str] = []
    joint, last = "", 0
    parser = expat.ParserCreate("utf-8")

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal joint
        path.append(name)
        if path[1:] == ["joint"]:
            joint = attributes["name"]
            spans[joint] = tag_end(), tag_end()
        elif path[1:] == ["joint", "origin"]:
            spans[joint] = parser.CurrentByteIndex, tag_end()

    def end(name: str) -> None:
        nonlocal last
        last = parser.CurrentByteIndex
        closing = text.startswith(b"</", last)  # not so after <origin/>
        if path[1:] == ["joint", "origin"] and closing:
            spans[joint] = spans[joint][0], tag_end()
        path.pop()

    def tag_end() -> int:
        found = _TAG.match(text, parser.CurrentByteIndex)
        assert found, "expat has found a tag there"
        return found.end()

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(text, True)
    return spans, last
