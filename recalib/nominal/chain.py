"""Forward kinematics and Jacobians of serial arms for many postures at once, in NumPy.

`recalib.nominal.kinematics` has the same from Pinocchio, posture after posture, and is what this is
tested against. Here the postures are the last axes of every array, so that each call of NumPy works
on all of them. Each is computed by itself: what is beside it changes not one bit.

A frame (3, 4, ...) is the upper part of homogeneous matrices, lengths in m.
"""

from collections.abc import Sequence
from typing import Self

import numpy as np
import pinocchio as pin

from recalib.errors import UnsuitableRobot
from recalib.nominal.kinematics import Arm, tool_frame

# A turn about z by q is ALONG + SINE sin q + COSINE cos q.
ALONG, COSINE = np.diag([0.0, 0, 1, 1]), np.diag([1.0, 1, 0, 0])
SINE = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])

# Of x, y and z the two others, in a circle: the cross product is a[NEXT] b[LAST] - a[LAST] b[NEXT].
NEXT, LAST = [1, 2, 0], [2, 0, 1]

BLOCK = 256  # postures


class Chain:
    """A serial arm as a product of frames, one for each joint, about whose z axis it turns.

    Args:
        arm: the chain does not follow when it changes.

    Raises UnsuitableRobot where a joint does not turn about an axis.
    """

    def __init__(self, arm: Arm):
        model, tool = arm.model, arm.model.frames[tool_frame(arm.model, arm.tool)]
        placements = [each.homogeneous for each in (*model.jointPlacements[1:], tool.placement)]
        for joint, turn in enumerate(_turns_of_z(model)):
            placements[joint] = placements[joint] @ turn
            placements[joint + 1] = turn.T @ placements[joint + 1]
        base, *links = placements
        # from each joint's frame to the next one, the last to the tool, as functions of its angle
        steps = np.stack([[part @ link for link in links] for part in (ALONG, SINE, COSINE)])
        steps[:, 0] = base @ steps[:, 0]
        self._base, self._steps = (
            base[:3, :, None, None],
            steps.reshape(3, 3, 2, 4, 4, 1, 1)[..., :3, :, :, :],
        )

    @classmethod
    def side_by_side(cls, chains: Sequence["Chain"]) -> Self:
        """Several chains as one, each of which takes its share of the postures."""
        together = cls.__new__(cls)
        together._base = np.concatenate([each._base for each in chains], axis=-2)
        together._steps = np.concatenate([each._steps for each in chains], axis=-2)
        return together

    def frames(self, angles: np.ndarray) -> np.ndarray:
        """Frames (7, 3, 4, share, n) of the joints, each before it turns, and of the tool.

        Args:
            angles: (6, share, n) rad.
        """
        # two joints at a time: a call of NumPy costs as much as its work on few postures
        pairs = np.ascontiguousarray(angles).reshape(3, 2, *angles.shape[1:])
        still, sine, cosine = self._steps
        steps = sine * np.sin(pairs)[:, :, None, None]
        steps += cosine * np.cos(pairs)[:, :, None, None]
        steps += still
        _multiply(steps[:, 0], steps[:, 1].copy(), out=steps[:, 1])
        frames = np.empty((7, *steps.shape[2:]))
        frames[0], frames[1:3] = self._base, steps[0]
        _multiply(frames[2], steps[1], out=frames[3:5])
        _multiply(frames[4], steps[2], out=frames[5:])
        return frames

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (share, n, 4, 4) of the tool at joint angles (share, n, 6) [rad]."""
        return np.concatenate(
            [
                to_poses(self.frames(angles[:, block].transpose(2, 0, 1))[-1])
                for block in blocks(angles.shape[-2])
            ],
            axis=-3,
        )


def _multiply(left: np.ndarray, right: np.ndarray, out: np.ndarray) -> None:
    """Products (..., 3, 4, share, n) of frames."""
    terms = left[..., :3, None, :, :] * right[..., None, :, :, :, :]
    np.add.reduce(terms, axis=-4, out=out)
    out[..., 3, :, :] += left[..., 3, :, :]


def blocks(postures: int) -> list[slice]:
    """Slices of so many postures, each of which the processor's cache holds with all its frames."""
    return [slice(first, first + BLOCK) for first in range(0, max(postures, 1), BLOCK)]


def jacobians(frames: np.ndarray) -> np.ndarray:
    """Jacobians (6, 6, share, n) of the tool, from the frames of a chain.

    They map joint velocities to the tool's linear [m/s] and angular [rad/s] velocity along the
    base's axes.
    """
    axes, levers = frames[:-1, :, 2], frames[-1, :, 3] - frames[:-1, :, 3]
    linear = axes[:, NEXT] * levers[:, LAST] - axes[:, LAST] * levers[:, NEXT]
    return np.concatenate([linear, axes], axis=1).swapaxes(0, 1)


def to_poses(frames: np.ndarray) -> np.ndarray:
    """The poses (share, n, 4, 4) of frames (3, 4, share, n)."""
    poses = np.empty((*frames.shape[2:], 4, 4))
    poses[..., :3, :] = frames.transpose(2, 3, 0, 1)
    poses[..., 3, :] = 0, 0, 0, 1
    return poses


def to_frames(poses: np.ndarray) -> np.ndarray:
    """The frames (3, 4, share, n) of poses (share, n, 4, 4)."""
    return poses[..., :3, :].transpose(2, 3, 0, 1).copy()


def _turns_of_z(model: pin.Model) -> list[np.ndarray]:
    """For each joint a turn (4, 4) of its frame that takes z to the axis about which it turns."""
    data, turns = model.createData(), []
    for joint in range(1, model.njoints):
        motion = pin.computeJointJacobian(model, data, pin.neutral(model), joint)[:, joint - 1]
        if motion[:3].any():
            raise UnsuitableRobot(f"joint {model.names[joint]!r} does not turn about an axis")
        axis, turn = motion[3:], np.eye(4)
        across = np.cross(np.eye(3)[np.abs(axis).argmin()], axis)  # exact where z is x, y or z
        across /= np.linalg.norm(across)
        turn[:3, :3] = np.column_stack([across, np.cross(axis, across), axis])
        turns.append(turn)
    return turns
