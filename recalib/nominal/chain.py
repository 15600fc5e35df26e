"""Serial arms in compiled loops, posture by posture.

Where a joint slides, its joint angle is a length [m]. Pinocchio says where joints and tool are
placed, and stays the reference. Other postures of a batch do not change a bit of a result. Numba
compiles the loops once and caches them in a file.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np

from recalib.nominal.kinematics import Arm, tool_frame
from recalib.nominal.newton import LONGEST_STEP, SINGULAR
from recalib.numerics.compiled import compiled

TOLERANCE = 1e-11  # of the residual, in m and rad: a hundredth of what is asked of the controller
STEPS = 25
SMALL = 1e-6  # m, rad: a turn whose sine is less is none, or half a turn


class Chain(NamedTuple):
    """Serial arms of n joints, side by side.

    Attributes:
        placements: (arm, n + 1, 3, 4) of each joint in the frame of the one before it, and of the
            tool in that of the last one: turns, and translations [m].
        axes: (arm, n, 3) about which the joints turn, or along which they slide, in their own
            frames.
        slides: (arm, n) whether they slide.
    """

    placements: np.ndarray
    axes: np.ndarray
    slides: np.ndarray

    @classmethod
    def of(cls, arm: Arm) -> Self:
        """A single arm; the chain does not follow when it changes."""
        model, frame = arm.model, arm.model.frames[tool_frame(arm.model, arm.tool)]
        placements = [*list(model.jointPlacements)[1:], frame.placement]
        matrices = [placement.homogeneous[:3] for placement in placements]
        return cls(np.array([matrices]), arm.axes[None], arm.slides[None])

    @classmethod
    def side_by_side(cls, chains: Sequence[Self]) -> Self:
        """The arms of several chains, with equally many joints."""
        return cls(*map(np.concatenate, zip(*chains, strict=True)))

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (arm, posture, 4, 4) of the tools [m] at joint angles (arm, posture, n) [rad].

        Raises ValueError: angles of other arms or joints.
        """
        self._check(angles, len(self.slides))
        return _forward(self, angles)

    def jacobians(self, angles: np.ndarray) -> np.ndarray:
        """Jacobians (posture, 6, n) of the first arm at joint angles (posture, n) [rad].

        From joint velocities to linear [m/s] and angular [rad/s] velocity of the tool along the
        base's axes. Raises ValueError: angles of other joints.
        """
        self._check(angles)
        return _jacobians(self, angles)

    def solve(self, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joint angles (posture, n) [rad] that take the tool of the first arm to poses.

        By Newton's method, each pose by itself. With more than six joints, each of its steps is the
        shortest; with fewer, the one that leaves least.

        Args:
            poses: (posture, 4, 4) m.
            start: (posture, n) rad nearby.

        Returns the angles and the error of each (posture,), the largest number of its residual
        in m and rad: above TOLERANCE, the pose was not reached. It is infinite where the pose or
        the start holds nan.

        Raises ValueError: angles of other joints, or not one start for each pose.
        """
        self._check(start)
        if poses.shape != (len(start), 4, 4):
            raise ValueError(f"poses are {poses.shape}; expected: ({len(start)}, 4, 4)")
        return _solve(self, poses, start.astype(float))

    def _check(self, angles: np.ndarray, *arms: int) -> None:
        """Raise ValueError unless angles are (*arms, posture, n): compiled loops do not look."""
        expected = *arms, np.atleast_2d(angles).shape[-2], self.slides.shape[1]
        if angles.shape != expected:
            raise ValueError(f"joint angles are {angles.shape}; expected: {expected}")


@compiled
def _forward(chain: Chain, angles: np.ndarray) -> np.ndarray:
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
def _stand(
    chain: Chain,
    arm: int,
    angles: np.ndarray,
    pose: np.ndarray,
    origins: np.ndarray,
    directions: np.ndarray,
) -> None:
    """Write the tool's pose (3 or 4, 4), and where the joints lie and point, both (n, 3)."""
    joints = len(angles)
    for row in range(3):
        for column in range(4):
            pose[row, column] = chain.placements[arm, 0, row, column]
    for joint in range(joints):
        axis, slides = chain.axes[arm, joint], chain.slides[arm, joint]
        for row in range(3):
            origins[joint, row] = pose[row, 3]
            directions[joint, row] = (
                pose[row, 0] * axis[0] + pose[row, 1] * axis[1] + pose[row, 2] * axis[2]
            )
        angle = 0.0 if slides else angles[joint]
        sine, cosine = np.sin(angle), np.cos(angle)
        versine = 1 - cosine
        x, y, z = axis
        placement = chain.placements[arm, joint + 1]
        for row in range(3):
            if slides:
                pose[row, 3] += angles[joint] * directions[joint, row]
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
def _jacobians(chain: Chain, angles: np.ndarray) -> np.ndarray:
    postures, joints = angles.shape
    jacobians, pose = np.empty((postures, 6, joints)), np.empty((3, 4))
    origins, directions = np.empty((joints, 3)), np.empty((joints, 3))
    for posture in range(postures):
        _stand(chain, 0, angles[posture], pose, origins, directions)
        _move(chain, pose, origins, directions, jacobians[posture])
    return jacobians


@compiled
def _move(
    chain: Chain,
    pose: np.ndarray,
    origins: np.ndarray,
    directions: np.ndarray,
    jacobian: np.ndarray,
) -> None:
    """Write how the tool moves (6, n) with joints that lie and point as `_stand` says."""
    for joint in range(len(origins)):
        slides = chain.slides[0, joint]
        for row in range(3):
            if slides:
                jacobian[row, joint] = directions[joint, row]
                jacobian[3 + row, joint] = 0
                continue
            one, other = (row + 1) % 3, (row + 2) % 3
            jacobian[row, joint] = directions[joint, one] * (
                pose[other, 3] - origins[joint, other]
            ) - directions[joint, other] * (pose[one, 3] - origins[joint, one])
            jacobian[3 + row, joint] = directions[joint, row]


@compiled
def _solve(chain: Chain, poses: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    joints = start.shape[1]
    found, error = start.copy(), np.full(len(start), np.inf)
    origins, directions = np.empty((joints, 3)), np.empty((joints, 3))
    reached, jacobian, residual = np.empty((3, 4)), np.empty((6, joints)), np.empty(6)
    step = np.empty(joints)
    for index in range(len(start)):
        angles, goal = start[index].copy(), poses[index]
        for _ in range(STEPS):
            _stand(chain, 0, angles, reached, origins, directions)
            largest = _residual(reached, goal, residual)
            if largest < error[index]:
                _copy(angles, found[index])
                error[index] = largest
            if error[index] <= TOLERANCE or np.isnan(largest):
                break
            _move(chain, reached, origins, directions, jacobian)
            if joints == 6:
                _copy(residual, step)
            if joints != 6 or not _eliminate(jacobian, step):
                _move(chain, reached, origins, directions, jacobian)
                _copy(_shortest_step(jacobian, residual), step)
            shorter = LONGEST_STEP / max(LONGEST_STEP, _longest(step))
            for joint in range(joints):
                angles[joint] += shorter * step[joint]
    return found, error


@compiled
def _copy(vector: np.ndarray, to: np.ndarray) -> None:
    for index in range(len(vector)):
        to[index] = vector[index]


@compiled
def _shortest_step(jacobian: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """Of the steps (n,) that leave least, the shortest; for n > 6, J' inv(J J') m."""
    if jacobian.shape[1] > 6:
        square, vector = np.zeros((6, 6)), residual.copy()
        for row in range(6):
            for column in range(6):
                for joint in range(jacobian.shape[1]):
                    square[row, column] += jacobian[row, joint] * jacobian[column, joint]
        if _eliminate(square, vector):
            step = np.zeros(jacobian.shape[1])
            for joint in range(len(step)):
                for row in range(6):
                    step[joint] += jacobian[row, joint] * vector[row]
            return step
    return np.linalg.pinv(jacobian, 1 / SINGULAR) @ residual


@compiled
def _residual(pose: np.ndarray, goal: np.ndarray, residual: np.ndarray) -> float:
    """Write what takes a pose to a goal (6,), along the base's axes; returns its largest number.

    The translation [m], and the turn as its axis times the sine of its angle [rad], which is the
    angle itself where Newton's method ends. The sine of half a turn is zero as well: infinity is
    returned for it.
    """
    for row in range(3):
        residual[row] = goal[row, 3] - pose[row, 3]
        one, other = (row + 1) % 3, (row + 2) % 3
        turn = 0.0
        for column in range(3):
            turn += (
                goal[other, column] * pose[one, column] - goal[one, column] * pose[other, column]
            )
        residual[3 + row] = turn / 2
    longest = _longest(residual)
    return np.inf if longest < SMALL and _is_half_a_turn(pose, goal) else longest


@compiled
def _is_half_a_turn(pose: np.ndarray, goal: np.ndarray) -> bool:
    """Whether a turn from pose to goal that is none or half a one is half a one."""
    trace = 0.0
    for row in range(3):
        for column in range(3):
            trace += goal[row, column] * pose[row, column]
    return trace < 1


@compiled
def _longest(vector: np.ndarray) -> float:
    """Its largest number; nan if there is one."""
    longest = 0.0
    for number in vector:
        if not abs(number) <= longest:
            longest = abs(number)
            if np.isnan(longest):
                break
    return longest


@compiled
def _eliminate(matrix: np.ndarray, vector: np.ndarray) -> bool:
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
