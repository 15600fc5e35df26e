"""Serial arms of turning joints in compiled loops, posture by posture.

Pinocchio says where joints and tool are placed, and stays the reference. What is beside a posture
changes not one bit of it. Numba compiles the loops once and keeps them in a file.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
import pinocchio as pin

from recalib.compiled import compiled
from recalib.errors import UnsuitableRobot
from recalib.nominal.kinematics import Arm, tool_frame

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
LONGEST_STEP = 0.5  # rad: keeps Newton's method on the branch that it starts on
SINGULAR = 1e9  # rad: a step so long comes from a singular Jacobian


class Chain(NamedTuple):
    """Serial arms of n turning joints, side by side.

    Attributes:
        placements: (arm, n + 1, 3, 4) of each joint in the frame of the one before it, and of the
            tool in that of the last one: turns, and translations [m].
        axes: (arm, n, 3) about which the joints turn, in their own frames.
    """

    placements: np.ndarray
    axes: np.ndarray

    @classmethod
    def of(cls, arm: Arm) -> Self:
        """A single arm; the chain does not follow when it changes.

        Raises UnsuitableRobot where a joint slides.
        """
        model, frame = arm.model, arm.model.frames[tool_frame(arm.model, arm.tool)]
        axes = [_axis(model, joint) for joint in range(1, model.njoints)]
        placements = [*list(model.jointPlacements)[1:], frame.placement]
        matrices = [placement.homogeneous[:3] for placement in placements]
        return cls(np.array([matrices]), np.array([axes]))

    @classmethod
    def side_by_side(cls, chains: Sequence[Self]) -> Self:
        """The arms of several chains, with equally many joints."""
        return cls(*map(np.concatenate, zip(*chains, strict=True)))

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (arm, posture, 4, 4) of the tools [m] at joint angles (arm, posture, n) [rad]."""
        return _forward(self, angles)

    def jacobians(self, angles: np.ndarray) -> np.ndarray:
        """Jacobians (posture, 6, n) of the first arm at joint angles (posture, n) [rad].

        From joint velocities to linear [m/s] and angular [rad/s] velocity of the tool along the
        base's axes.
        """
        return _jacobians(self, angles)

    def solve(self, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joint angles (posture, 6) [rad] that take the tool of the first arm to poses.

        By Newton's method, each pose by itself.

        Args:
            poses: (posture, 4, 4) m.
            start: (posture, 6) rad nearby.

        Returns the angles and what is left of each residual (posture,), the largest of its numbers
        in m and rad: above TOLERANCE, the pose was not reached.
        """
        return _solve(self, poses, start)


def _axis(model: pin.Model, joint: int) -> np.ndarray:
    """About which axis (3,) a joint turns, in its own frame."""
    data, at = model.createData(), np.zeros(model.nq)
    pin.computeJointJacobians(model, data, at)
    angular = pin.getJointJacobian(model, data, joint, pin.LOCAL)[3:]
    column = model.joints[joint].idx_v
    if not angular[:, column].any():
        raise UnsuitableRobot(f"a joint of {model.name} slides; valid: joints that turn")
    return angular[:, column]


@compiled
def _forward(chain, angles):
    arms, postures, joints = angles.shape
    poses = np.zeros((arms, postures, 4, 4))
    origins, directions = np.empty((joints, 3)), np.empty((joints, 3))
    for arm in range(arms):
        for posture in range(postures):
            pose = poses[arm, posture]
            _stand(chain, arm, angles[arm, posture], pose, origins, directions)
            pose[3, 3] = 1
    return poses


@compiled
def _stand(chain, arm, angles, pose, origins, directions):
    """Write the tool's pose (3 or 4, 4), and where the joints lie and turn, both (n, 3)."""
    joints = len(angles)
    pose[:3] = chain.placements[arm, 0]
    for joint in range(joints):
        axis, angle = chain.axes[arm, joint], angles[joint]
        for row in range(3):
            origins[joint, row] = pose[row, 3]
            directions[joint, row] = (
                pose[row, 0] * axis[0] + pose[row, 1] * axis[1] + pose[row, 2] * axis[2]
            )
        sine, cosine = np.sin(angle), np.cos(angle)
        versine = 1 - cosine
        x, y, z = axis
        placement = chain.placements[arm, joint + 1]
        for row in range(3):
            a, b, c = pose[row, 0], pose[row, 1], pose[row, 2]
            # Rodrigues' formula: each row of the frame is turned about the axis, the other way
            along = versine * directions[joint, row]
            d = cosine * a + sine * (b * z - c * y) + along * x
            e = cosine * b + sine * (c * x - a * z) + along * y
            f = cosine * c + sine * (a * y - b * x) + along * z
            for column in range(4):
                turned = (
                    d * placement[0, column] + e * placement[1, column] + f * placement[2, column]
                )
                pose[row, column] = turned + (pose[row, 3] if column == 3 else 0)


@compiled
def _jacobians(chain, angles):
    postures, joints = angles.shape
    jacobians, pose = np.empty((postures, 6, joints)), np.empty((3, 4))
    origins, directions = np.empty((joints, 3)), np.empty((joints, 3))
    for posture in range(postures):
        _stand(chain, 0, angles[posture], pose, origins, directions)
        _turn(pose, origins, directions, jacobians[posture])
    return jacobians


@compiled
def _turn(pose, origins, directions, jacobian):
    """Write how the tool moves (6, n) with joints that lie and turn as `_stand` says."""
    for joint in range(len(origins)):
        for row in range(3):
            one, other = (row + 1) % 3, (row + 2) % 3
            jacobian[row, joint] = directions[joint, one] * (
                pose[other, 3] - origins[joint, other]
            ) - directions[joint, other] * (pose[one, 3] - origins[joint, one])
            jacobian[3 + row, joint] = directions[joint, row]


@compiled
def _solve(chain, poses, start):
    joints = start.shape[1]
    found, left = start.copy(), np.full(len(start), np.inf)
    origins, directions = np.empty((joints, 3)), np.empty((joints, 3))
    reached, jacobian, missing = np.empty((3, 4)), np.empty((6, joints)), np.empty(6)
    turns = np.empty(joints)
    for index in range(len(start)):
        angles, goal = start[index].copy(), poses[index]
        for _ in range(STEPS):
            _stand(chain, 0, angles, reached, origins, directions)
            residual = _missing(reached, goal, missing)
            if residual < left[index]:
                found[index], left[index] = angles, residual
            if left[index] <= TOLERANCE:
                break
            _turn(reached, origins, directions, jacobian)
            turns[:] = missing
            if not _eliminate(jacobian, turns):  # singular: the smallest solution
                _turn(reached, origins, directions, jacobian)
                turns[:] = np.linalg.pinv(jacobian, 1 / SINGULAR) @ missing
            shorter = LONGEST_STEP / max(LONGEST_STEP, _longest(turns))
            for joint in range(joints):
                angles[joint] += shorter * turns[joint]
    return found, left


@compiled
def _missing(pose, goal, missing):
    """Write what takes a pose to a goal (6,), along the base's axes; returns its largest number.

    The translation [m], and the turn as its axis times the sine of its angle [rad], which is the
    angle itself where Newton's method ends.
    """
    for row in range(3):
        missing[row] = goal[row, 3] - pose[row, 3]
        one, other = (row + 1) % 3, (row + 2) % 3
        turn = 0.0
        for column in range(3):
            turn += (
                goal[other, column] * pose[one, column] - goal[one, column] * pose[other, column]
            )
        missing[3 + row] = turn / 2
    return _longest(missing)


@compiled
def _longest(vector):
    """Its largest number; nan if there is one."""
    longest = 0.0
    for number in vector:
        if not abs(number) <= longest:
            longest = abs(number)
    return longest


@compiled
def _eliminate(matrix, vector):
    """Solve linear equations in place, and say whether they can be solved."""
    size = len(vector)
    for column in range(size):
        pivot = column
        for row in range(column + 1, size):
            if abs(matrix[row, column]) > abs(matrix[pivot, column]):
                pivot = row
        for other in range(column, size):
            matrix[column, other], matrix[pivot, other] = (
                matrix[pivot, other],
                matrix[column, other],
            )
        vector[column], vector[pivot] = vector[pivot], vector[column]
        for row in range(column + 1, size):
            factor = matrix[row, column] / matrix[column, column]
            for other in range(column + 1, size):
                matrix[row, other] -= factor * matrix[column, other]
            vector[row] -= factor * vector[column]
    for row in range(size - 1, -1, -1):
        for other in range(row + 1, size):
            vector[row] -= matrix[row, other] * vector[other]
        vector[row] /= matrix[row, row]
    return _longest(vector) <= SINGULAR
