"""Forward kinematics, Jacobians and gravity of one arm for many joint angles, by Pinocchio."""

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
        poses = []
        for q in angles:
            pin.forwardKinematics(self.model, self._data, q)
            poses.append(pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous)
        return np.array(poses).reshape(-1, 4, 4)

    def forward_and_jacobian(self, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Poses (n, 4, 4) as `forward`, and the tool's Jacobians (n, 6, 6).

        A Jacobian maps joint velocities to the tool's linear [m/s] and angular [rad/s] velocity
        along the base's axes.
        """
        poses, jacobians = [], []
        for q in angles:
            jacobians.append(
                pin.computeFrameJacobian(
                    self.model, self._data, q, self._frame, pin.LOCAL_WORLD_ALIGNED
                )
            )
            poses.append(pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous)
        return np.array(poses).reshape(-1, 4, 4), np.array(jacobians).reshape(-1, 6, 6)

    def forward_and_all_jacobians(
        self, angles: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Poses and Jacobians as `forward_and_jacobian`, and those by the placements (n, 6, 7 * 6).

        A placement's motion [m, rad] is along the axes of what it places: each of the joints, and
        last the tool.
        """
        poses, joints, placements = [], [], []
        for q in angles:
            joints.append(
                pin.computeFrameJacobian(
                    self.model, self._data, q, self._frame, pin.LOCAL_WORLD_ALIGNED
                )
            )
            poses.append(pin.updateFramePlacement(self.model, self._data, self._frame).homogeneous)
            regressor = pin.computeFrameKinematicRegressor(
                self.model, self._data, self._frame, pin.LOCAL_WORLD_ALIGNED
            )
            placements.append(regressor)
        poses, tools = np.array(poses), np.zeros((len(angles), 6, 6))
        tools[:, :3, :3] = tools[:, 3:, 3:] = poses[:, :3, :3]
        return poses, np.array(joints), np.concatenate([np.array(placements), tools], axis=-1)

    def gravity_torque(self, angles: np.ndarray) -> np.ndarray:
        """Torques (n, 6) [N m] that hold the arm against gravity at joint angles (n, 6) [rad]."""
        return np.array(
            [pin.computeGeneralizedGravity(self.model, self._data, q) for q in angles]
        ).reshape(-1, 6)
