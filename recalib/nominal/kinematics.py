"""Forward kinematics, Jacobians and gravity torques of one arm for many postures, by Pinocchio.

The "angle" of a sliding joint is a length [m], its "torque" a force [N].
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from recalib.arrays import Shape, array_of, check_size
from recalib.files.quantities import ANGLE, LENGTH


def tool_frame(model: pin.Model, tool: str) -> int:
    """Index of the frame of the link `tool`; a joint may have the same name."""
    return model.getFrameId(tool, pin.FrameType.BODY)


@dataclass(frozen=True)
class Coupling:
    """The map from reported joint coordinates to all joint coordinates: joints may share a motor.

    Attributes:
        columns: names of the joints that the controller reports.
        slides: (column,) whether each of them slides.
        gains: (joint, column) derivatives of joint coordinates by reported ones.
        shifts: (joint,) rad, m, joint coordinates if all reported coordinates are zero.
        limits: (2, column) rad, m, lower and upper.
    """

    columns: tuple[str, ...]
    slides: np.ndarray
    gains: np.ndarray
    shifts: np.ndarray
    limits: np.ndarray

    def given(self, name: str, coordinates: ArrayLike, *shapes: Shape) -> np.ndarray:
        """Check a caller's coordinates (..., columns) [rad, m] against several possible shapes.

        Raises InvalidSetting for another shape, NaN, or a number too large for its unit.
        """
        array = array_of(name, coordinates, *((*shape, len(self.columns)) for shape in shapes))
        for kind, chosen in ((ANGLE, ~self.slides), (LENGTH, self.slides)):
            check_size(name, array[..., chosen], kind)
        return array

    def joints(self, columns: np.ndarray) -> np.ndarray:
        """Coordinates (n, joints) of all joints, from reported coordinates (n, columns)."""
        return columns @ self.gains.T + self.shifts

    def reported(self, joints: np.ndarray) -> np.ndarray:
        """Reported coordinates (n, columns), from those of all joints (n, joints)."""
        return (joints - self.shifts) @ np.linalg.pinv(self.gains).T


class Arm:
    """A serial arm: a Pinocchio model and the tool frame at its end.

    Args:
        model: the model, a chain of joints that turn about or slide along one axis.
        tool: name of the link that is the tool.
        base: name of the link whose frame is the base frame; it equals the model's world frame.
        coupling: the coupling, if joints follow others; None if each joint has its own motor.
    """

    def __init__(self, model: pin.Model, tool: str, base: str, coupling: Coupling | None = None):
        self.model, self.tool, self.base, self._coupling = model, tool, base, coupling
        self._data = model.createData()
        self._frame = tool_frame(model, tool)

    def copy(self) -> Self:
        """A copy with its own Pinocchio model."""
        return type(self)(pin.Model(self.model), self.tool, self.base, self._coupling)

    @cached_property
    def coupling(self) -> Coupling:
        """The coupling from reported joints to all joints; the identity if each has a motor."""
        limits = np.array([self.model.lowerPositionLimit, self.model.upperPositionLimit])
        gains, count = np.eye(len(self.joints)), len(self.joints)
        identity = Coupling(self.joints, self.slides, gains, np.zeros(count), limits)
        return self._coupling or identity

    @property
    def end(self) -> pin.Frame:
        """The tool's frame, placed in the last joint's frame. Changing it changes the arm."""
        return self.model.frames[self._frame]

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints, from the base to the tool."""
        return tuple(self.model.names)[1:]

    @property
    def links(self) -> dict[str, int]:
        """Index of the joint that moves each link, by the link's name; 0 for the base.

        A link ends at the next joint; the last link ends at the tool.
        """
        links: dict[str, int] = {}
        for frame in self.model.frames:
            is_link = frame.type == pin.FrameType.BODY and frame.name != "world"
            if is_link and frame.parentJoint not in links.values():
                links[frame.name] = frame.parentJoint
        return links

    @cached_property
    def slides(self) -> np.ndarray:
        """(joint,) whether a joint slides along its axis; otherwise it turns about it."""
        return np.logical_not(self._motions[:, 3:].any(axis=1))

    @cached_property
    def axes(self) -> np.ndarray:
        """(joint, 3) unit vectors along the joints' axes, each in its joint's frame."""
        return np.where(self.slides[:, None], self._motions[:, :3], self._motions[:, 3:])

    @cached_property
    def _motions(self) -> np.ndarray:
        """(joint, 6) linear and angular motion of each joint in its own frame."""
        model, data = self.model, self.model.createData()
        pin.computeJointJacobians(model, data, pin.neutral(model))
        jacobians = [
            pin.getJointJacobian(model, data, j, pin.LOCAL) for j in range(1, model.njoints)
        ]
        return np.array([full.reshape(6, -1)[:, joint] for joint, full in enumerate(jacobians)])

    @property
    def massless(self) -> bool:
        """Whether the links have no masses, so that the effect of gravity is unknown."""
        return not any(inertia.mass for inertia in list(self.model.inertias)[1:])

    def forward(self, angles: ArrayLike) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m] at joint angles (n, joint) [rad].

        One posture (joint,) gives one pose (4, 4). This method and those below raise InvalidSetting
        for another shape.
        """
        postures, shape = self._postures(angles)
        poses = []
        for q in postures:
            pin.forwardKinematics(self.model, self._data, q)
            poses.append(pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous)
        return np.array(poses).reshape(*shape, 4, 4)

    def _postures(self, angles: ArrayLike) -> tuple[np.ndarray, tuple[int, ...]]:
        """Joint angles (n, joint), and the shape of the results: (n,), or () for one posture."""
        count = self.model.nv
        array = array_of("joint angles", angles, ("n", count), (count,))
        return array.reshape(-1, count), array.shape[:-1]

    def skeleton(self, angles: ArrayLike) -> np.ndarray:
        """Positions (n, joint + 2, 3) [m] of base, joints and tool at angles (n, joint) [rad]."""
        postures, shape = self._postures(angles)
        points = np.zeros((len(postures), self.model.njoints + 1, 3))
        for skeleton, q in zip(points, postures, strict=True):
            pin.forwardKinematics(self.model, self._data, q)
            skeleton[-1] = pin.updateFramePlacement(self.model, self._data, self._frame).translation
            skeleton[1:-1] = [placement.translation for placement in list(self._data.oMi)[1:]]
        return points.reshape(*shape, *points.shape[1:])

    def forward_and_jacobian(self, angles: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) like `forward`, and the tool's Jacobians (n, 6, joint).

        A Jacobian maps joint velocities to the tool's linear [m/s] and angular [rad/s] velocity
        along the base's axes.
        """
        postures, shape = self._postures(angles)
        pairs = [self._pose_and_jacobian(q) for q in postures]
        poses, jacobians = (np.array([pair[part] for pair in pairs]) for part in (0, 1))
        return poses.reshape(*shape, 4, 4), jacobians.reshape(*shape, 6, self.model.nv)

    def _pose_and_jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The tool's pose (4, 4) and Jacobian in one posture. Leaves Pinocchio's data in it."""
        model, data, axes = self.model, self._data, pin.LOCAL_WORLD_ALIGNED
        jacobian = pin.computeFrameJacobian(model, data, q, self._frame, axes)
        return pin.updateFramePlacement(model, data, self._frame).homogeneous, jacobian

    def forward_and_all_jacobians(
        self, angles: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Poses and Jacobians like `forward_and_jacobian`, and Jacobians of the placements.

        The latter (n, 6, (joint + 1) * 6) are derivatives by a motion [m, rad] of each joint's
        placement, and last the tool's, along the axes of the placed frame.
        """
        count, (model, data, axes) = len(angles), (self.model, self._data, pin.LOCAL_WORLD_ALIGNED)
        poses, joints = np.empty((count, 4, 4)), np.empty((count, 6, model.nv))
        placements = np.zeros((count, 6, 6 * (model.nv + 1)))
        for row, q in enumerate(angles):
            poses[row], by_joint = self._pose_and_jacobian(q)
            joints[row] = by_joint.reshape(6, -1)  # of a single joint, Pinocchio returns a vector
            regressor = pin.computeFrameKinematicRegressor(model, data, self._frame, axes)
            placements[row, :, :-6] = regressor
        placements[:, :3, -6:-3] = placements[:, 3:, -3:] = poses[:, :3, :3]
        return poses, joints, placements

    def gravity_torque(self, angles: ArrayLike) -> np.ndarray:
        """Torques (n, joint) [N m] that hold the arm against gravity at angles (n, joint) [rad]."""
        postures, shape = self._postures(angles)
        torques = [pin.computeGeneralizedGravity(self.model, self._data, q) for q in postures]
        return np.array(torques).reshape(*shape, self.model.nv)
