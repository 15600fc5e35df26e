"""Kinematics of a Universal Robots arm in the layout of ur_description (default_kinematics.yaml).

In this layout, a joint's frame is that of Denavit and Hartenberg, with its z axis along the joint.
A URDF may have other frames. Each differs from the layout's by a fixed transformation, which
follows from the nominal arm. Thus nearly parallel axes move no frame far away.
"""

import hashlib
from itertools import accumulate

import numpy as np
import pinocchio as pin

from recalib.identification.calibration import Calibration
from recalib.laboratory.urdf.origins import angles_of, offset_poses
from recalib.nominal.kinematics import Arm

JOINTS = "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"
LINKS = "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"
FLANGE = "tool0"
ALIKE = 1e-6  # m, rad: the largest difference from the pattern of these arms
_NUMBERS = "x", "y", "z", "roll", "pitch", "yaw"


def kinematics_yaml(calibration: Calibration) -> str | None:
    """The origins of the corrected arm's joints as YAML; None if it is not such an arm.

    The YAML has no place for errors beyond the last joint.
    """
    nominal = calibration.model.nominal
    if (pattern := _pattern(nominal)) is None:
        return None
    # poses of the layout's frames relative to the URDF's joint frames, with the base first
    relative = np.linalg.inv([np.eye(4), *_frames(nominal.model)]) @ pattern
    corrected = calibration.model.own_arm(calibration.estimate.parameters).model
    placements = [placement.homogeneous for placement in corrected.jointPlacements[1:]]
    origins = np.linalg.inv(relative[:-1]) @ placements @ offset_poses(calibration) @ relative[1:]
    lines = ["kinematics:"]
    for link, origin in zip(LINKS, origins, strict=True):
        numbers = zip(_NUMBERS, [*origin[:3, 3], *angles_of(origin)], strict=True)
        lines += [f"  {link}:", *(f"    {name}: {number:.17g}" for name, number in numbers)]
    digest = hashlib.sha256("\n".join(lines).encode()).hexdigest()
    return "\n".join([*lines, f"  hash: recalib_{digest[:16]}", ""])


def _frames(model: pin.Model) -> list[np.ndarray]:
    """Poses (4, 4) of the joints' frames in the base, with all joints at zero."""
    data = model.createData()
    pin.forwardKinematics(model, data, np.zeros(model.nq))
    return [placement.homogeneous for placement in data.oMi[1:]]


def _pattern(arm: Arm) -> list[np.ndarray] | None:
    """Poses (4, 4) in the base of the layout's base and joint frames, with all joints at zero.

    None if the arm's joints have other names or are placed differently.
    """
    names = [f"{joint}_joint" for joint in JOINTS]
    if len(arm.joints) != 6 or not all(map(str.endswith, arm.joints, names)):
        return None
    turned = np.diag([-1.0, -1.0, 1.0, 1.0])  # the manufacturer's base has its x axis backwards
    flange = f"{arm.joints[0].removesuffix(names[0])}{FLANGE}"
    if not arm.model.existFrame(flange, pin.FrameType.BODY):
        return None
    at_zero = Arm(arm.model, flange, arm.base).forward(np.zeros((1, 6)))[0]
    _, lift, elbow, one, two, three, end = (
        (turned @ frame)[:3, 3] for frame in [*_frames(arm.model), at_zero]
    )
    lengths = [
        _pose(z=lift[2]),
        _pose(roll=np.pi / 2),
        _pose(x=elbow[0]),
        _pose(x=one[0] - elbow[0], z=-two[1]),
        _pose(y=three[2] - lift[2], roll=np.pi / 2),
        _pose(y=two[1] - end[1], roll=-np.pi / 2),
    ]
    pattern = [*accumulate([turned, *lengths], np.matmul)]
    for frame, axis, other in zip(_frames(arm.model), arm.axes, pattern[1:], strict=True):
        # the joint turns about the z axis of the other frame
        direction, between = frame[:3, :3] @ axis, other[:3, 3] - frame[:3, 3]
        apart = np.abs(np.cross(direction, between)).max()
        if not max(np.abs(direction - other[:3, 2]).max(), apart) < ALIKE:
            return None
    return pattern


def _pose(x: float = 0.0, y: float = 0.0, z: float = 0.0, roll: float = 0.0) -> np.ndarray:
    return pin.SE3(pin.rpy.rpyToMatrix(roll, 0.0, 0.0), np.array([x, y, z])).homogeneous
