"""Forward kinematics and Jacobians of one arm for many joint angles, by Pinocchio."""

import numpy as np
import pinocchio as pin


def tool_frame(model: pin.Model, tool: str) -> int:
    """Index of the frame of the link `tool`, which may share its name with a joint."""
    return model.getFrameId(tool, pin.FrameType.BODY)


class Arm:
    """A serial arm: a Pinocchio model and the tool frame at its end.

    Args:
        model: the model, with six joints of one degree of freedom.
        tool: name of the link that is the tool.
    """

    def __init__(self, model: pin.Model, tool: str):
        self.model, self.tool = model, tool
        self._data = model.createData()
        self._frame = tool_frame(model, tool)

    def forward(self, angles: np.ndarray) -> np.ndarray:
        """Poses (n, 4, 4) of the tool in the base frame [m] at joint angles (n, 6) [rad]."""
        poses = np.empty((len(angles), 4, 4))
        for pose, q in zip(poses, angles, strict=True):
            pin.forwardKinematics(self.model, self._data, q)
            pose[:] = pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous
        return poses

    def forward_and_jacobian(self, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as `forward`, and the tool's Jacobians (n, 6, 6).

        A Jacobian maps joint velocities to the tool's linear [m/s] and angular [rad/s] velocity along the base's axes.
        """
        poses, jacobians = np.empty((len(angles), 4, 4)), np.empty((len(angles), 6, 6))
        for pose, jacobian, q in zip(poses, jacobians, angles, strict=True):
            jacobian[:] = pin.computeFrameJacobian(self.model, self._data, q, self._frame, pin.LOCAL_WORLD_ALIGNED)
            pose[:] = pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous
        return poses, jacobians
