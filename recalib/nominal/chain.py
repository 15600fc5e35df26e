"""Forward kinematics and Jacobians of serial arms for many postures in few calls of NumPy.

As a function of one joint's angle q, a frame on the arm beyond it is a constant plus multiples of
sin q and cos q. Over three joints it is a sum of their 27 products with constant weights. So an arm
is taken as two halves of three joints, from the base to the wrist, the frame of the fourth joint
before it turns, and from there to the tool. The weights follow from Pinocchio's kinematics at 27
postures of each half. Every posture is computed by itself: what is beside it changes not one bit.
"""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple, Self

import numpy as np
import pinocchio as pin

from recalib.errors import UnsuitableRobot
from recalib.nominal.kinematics import Arm, tool_frame

WRIST = 4  # a joint
THIRDS = np.array(list(product(2 * np.pi / 3 * np.arange(3), repeat=3)))  # of a turn, (27, 3) rad


class Motion(NamedTuple):
    """Where arms stand and how they move.

    Attributes:
        tools: (share, n, 3, 4) poses [m] of the tools without their last row.
        jacobians: (share, n, 6, 6) from joint velocities to linear [m/s] and angular [rad/s]
            velocity of the tool along the base's axes. The linear one is that of a point of the
            tool's link: the one that is at the wrist now.
        wrists: (share, n, 3) m.
    """

    tools: np.ndarray
    jacobians: np.ndarray
    wrists: np.ndarray


class Chain:
    """A serial arm of six turning joints.

    Args:
        arm: the chain does not follow when it changes.

    Raises UnsuitableRobot where a joint slides.
    """

    def __init__(self, arm: Arm):
        halves = [[_half(arm, half, angles) for angles in THIRDS] for half in (0, 1)]
        weights = np.linalg.solve(_products(THIRDS), np.reshape(halves, (2, len(THIRDS), -1)))
        self._weights = weights.reshape(np.shape(halves))

    @classmethod
    def side_by_side(cls, chains: Sequence["Chain"]) -> Self:
        """Several chains as one, each of which takes its share of the postures."""
        together = cls.__new__(cls)
        together._weights = np.stack([each._weights for each in chains])[:, None]
        return together

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (share, n, 4, 4) of the tool [m] at joint angles (share, n, 6) [rad]."""
        poses = np.zeros((*angles.shape[:-1], 4, 4))
        poses[..., :3, :] = self._halves(angles, self._weights[..., :4])[..., 1, :, :]
        poses[..., 3, 3] = 1
        return poses

    def move(self, angles: np.ndarray) -> Motion:
        """The motion at joint angles (share, n, 6) [rad]."""
        postures, halves = angles.shape[:-1], self._halves(angles, self._weights)
        # (share, n, half, axis, linear or angular, joint), with the halves beside their joints
        columns = halves[..., 4:].reshape(*postures, 2, 3, 2, 3).transpose(0, 1, 4, 3, 2, 5)
        return Motion(halves[..., 1, :, :4], columns.reshape(*postures, 6, 6), halves[..., 0, :, 3])

    def _halves(self, angles: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Both halves' columns (share, n, 2, 3, ...) in the base frame: see `_half`."""
        products = _products(angles.reshape(*angles.shape[:-1], 2, 3))
        columns = products[..., None, :] @ weights.reshape(*weights.shape[:-2], -1)
        halves = columns.reshape(*products.shape[:-1], 3, -1)
        near, far = halves[..., 0, :, :], halves[..., 1, :, :]
        far[...] = near[..., :3] @ far
        far[..., 3] += near[..., 3]
        return halves


def _half(arm: Arm, half: int, angles: np.ndarray) -> np.ndarray:
    """Of the half's last frame (3, 4) and of its joints' Jacobian at the wrist two (3, 3), (3, 10).

    In the half's first frame.

    Args:
        half: 0 from the base to the wrist, 1 from there to the tool.
        angles: (3,) rad of the half's joints; those of the other half are at zero.
    """
    model, data, joints = arm.model, arm.model.createData(), slice(3 * half, 3 * half + 3)
    posture, frame = np.zeros(6), tool_frame(model, arm.tool)
    posture[joints] = angles
    jacobian = pin.computeFrameJacobian(model, data, posture, frame, pin.LOCAL_WORLD_ALIGNED)
    tool = pin.updateFramePlacement(model, data, frame)
    wrist = data.oMi[WRIST - 1] * model.jointPlacements[WRIST]
    linear, angular = np.split(jacobian[:, joints], 2)
    if not angular.any(axis=0).all():
        raise UnsuitableRobot(f"a joint of {model.name} slides; valid: joints that turn")
    linear += np.cross(angular, (wrist.translation - tool.translation)[:, None], axis=0)
    first, last = (pin.SE3.Identity(), wrist) if half == 0 else (wrist, tool)
    into = first.rotation.T
    return np.hstack([first.actInv(last).homogeneous[:3], into @ linear, into @ angular])


def _products(angles: np.ndarray) -> np.ndarray:
    """The products (..., 27) of 1, sine or cosine of three joints' angles (..., 3) [rad]."""
    each = angles.reshape(-1, 3).T.copy()  # the postures last: much to do in each call of NumPy
    waves = np.empty((3, *each.shape))
    waves[0], waves[1], waves[2] = 1, np.sin(each), np.cos(each)
    products = (waves[:, None, 0] * waves[:, 1])[:, :, None] * waves[:, 2]
    return products.reshape(27, -1).T.copy().reshape(*angles.shape[:-1], 27)
