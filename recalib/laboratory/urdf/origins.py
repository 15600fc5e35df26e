"""The user's own URDF with corrected origins; every other byte of the file stays unchanged.

A calibration moves placements by twists and joints by offsets. Both go into the origins of joints:
an offset turns a joint's frame about its own axis. If a moving joint carries the tool link
directly, no origin remains to correct the tool. The corrected tool is then a new link.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from recalib.errors import UnsuitableRobot
from recalib.files.storage import encoding
from recalib.identification.calibration import Calibration
from recalib.nominal.descriptions import link_of, local_name, parsed
from recalib.nominal.kinematics import Arm

CORRECTED = "_corrected"  # appended to the tool's name in the name of the new link
_TAG = re.compile(rb"</?(?P<prefix>(?:[^\s:>\"']+:)?)(?:[^>\"']|\"[^\"]*\"|'[^']*')*>")


def corrected_urdf(source: bytes, calibration: Calibration) -> tuple[bytes, str]:
    """The nominal arm's URDF with corrected geometry, and the name of its tool link.

    Raises UnsuitableRobot if joints are inside XML entities, where they cannot be changed.
    """
    nominal, parameters = calibration.model.nominal, calibration.estimate.parameters
    arm, offsets = calibration.model.own_arm(parameters), offset_poses(calibration)
    moving, (fixed, last) = _segments(source, nominal)
    origins = {}
    for joint, (before, moved) in enumerate(moving, start=1):
        placement = arm.model.jointPlacements[joint].homogeneous
        origins[moved] = np.linalg.inv(before) @ placement @ offsets[joint - 1]
    tool = arm.end.placement.homogeneous
    if last is not None:
        origins[last] = np.linalg.inv(fixed) @ tool
        return with_origins(source, origins), nominal.tool
    name = nominal.tool + CORRECTED
    added = (
        f'  <link name="{name}"/>\n  <joint name="{name}" type="fixed">\n'
        f'    <parent link="{nominal.tool}"/>\n    <child link="{name}"/>\n'
        f"    {origin_element(tool)}\n  </joint>\n"
    )
    return with_origins(source, origins, added), name


def with_origins(source: bytes, origins: Mapping[str, np.ndarray], added: str = "") -> bytes:
    """The URDF with new origins (4, 4) [m] of the named joints, and with XML added at its end.

    Nothing else changes. Raises UnsuitableRobot like `corrected_urdf`.
    """
    code = encoding(source)
    text = source.decode(code).encode("utf-8")
    spans, last, prefix = _origin_spans(text)
    pieces, done = [], 0
    for joint in sorted(origins, key=lambda joint: spans[joint]):
        start, end = spans[joint]
        new = origin_element(origins[joint]).replace("<", f"<{prefix}")
        pieces += [text[done:start], (new if start < end else f"\n    {new}").encode()]
        done = end
    more = re.sub("(</?)", rf"\1{prefix}", added).encode("utf-8")
    changed = b"".join([*pieces, text[done:last], more, text[last:]])
    return changed.decode("utf-8").encode(code)


def origin_element(pose: np.ndarray) -> str:
    """The XML of a joint's origin at a pose (4, 4) [m]."""
    return f'<origin xyz="{written(pose[:3, 3])}" rpy="{written(angles_of(pose))}"/>'


def written(vector: np.ndarray) -> str:
    """Numbers (n,) as text for a URDF, with all digits."""
    return " ".join(f"{number + 0.0:.17g}" for number in vector)


def offset_poses(calibration: Calibration) -> np.ndarray:
    """The motions (joints, 4, 4) [m] of the joints' frames due to their offsets."""
    arm = calibration.model.nominal
    offsets = calibration.model.coefficients(calibration.estimate.parameters)["offset"]
    moves, slides = arm.axes * offsets[:, None], arm.slides[:, None]
    poses = np.tile(np.eye(4), (len(moves), 1, 1))
    poses[:, :3, :3] = Rotation.from_rotvec(np.where(slides, 0.0, moves)).as_matrix()
    poses[:, :3, 3] = np.where(slides, moves, 0.0)
    return poses


def angles_of(pose: np.ndarray) -> np.ndarray:
    """Roll, pitch and yaw (3,) [rad] of a pose (4, 4), exact even at a pitch of 90 degrees.

    Pitch and yaw are computed after the roll is undone.
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
    """For each moving joint, and for the tool: the product (4, 4) of the origins of fixed joints
    before it, and the name of the joint whose origin places it. The tool may have no such joint.
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
            last, origin = (fixed, name), joint.find("origin")
            given = {} if origin is None else origin.attrib
            texts = (given.get(key, "0 0 0") for key in ("xyz", "rpy"))
            place, angles = (np.array(text.split(), dtype=float) for text in texts)
            fixed = fixed @ pin.SE3(pin.rpy.rpyToMatrix(angles), place).homogeneous
    return moving, last


def _origin_spans(text: bytes) -> tuple[dict[str, tuple[int, int]], int, str]:
    """The byte range of each joint's origin, which is empty where an origin has to be inserted.

    Also the position of the root's end tag, and the prefix of a namespace in the names of tags. The
    text is in UTF-8, even if it declares another encoding.
    """
    spans: dict[str, tuple[int, int]] = {}
    path: list[tuple[str, int]] = []  # names, and the ends of self-closing tags (others: 0)
    joint, last, prefix = "", 0, ""
    parser = expat.ParserCreate("utf-8", "}")

    def tag() -> re.Match[bytes]:
        found = _TAG.match(text, parser.CurrentByteIndex)
        if not found:
            raise UnsuitableRobot("the URDF has elements in entities; try: an expanded file")
        return found

    def names() -> list[str]:
        return [local_name(name, path[0][0]) for name, _ in path[1:]]

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal joint, prefix
        found = tag()
        path.append((name, found.end() if found[0].endswith(b"/>") else 0))
        if len(path) == 1:
            prefix = found["prefix"].decode("utf-8")
        elif names() == ["joint"]:
            joint = attributes["name"]
            spans[joint] = found.end(), found.end()
        elif names() == ["joint", "origin"] and spans[joint][0] == spans[joint][1]:
            spans[joint] = found.start(), 0

    def end(name: str) -> None:
        nonlocal last
        # after a self-closing tag, expat's index is the beginning of the next token
        last = path[-1][1] or tag().end()
        if names() == ["joint", "origin"] and not spans[joint][1]:
            spans[joint] = spans[joint][0], last
        path.pop()
        if not path:
            last = tag().start()

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(text, True)
    return spans, last, prefix
