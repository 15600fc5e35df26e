"""An arm's points and derivatives, beside finite differences."""

import numpy as np
import pinocchio as pin
import pytest

from recalib import load_arm
from recalib.nominal import tool_frame

ARMS = {
    "ur10_robot.urdf": ("tool0", [0.0, -1.4, 2.1, -2.9, -1.6, 0.1]),
    "tiago.urdf": ("hand_tool_link", [0.2, 1.0, -0.5, 1.0, 1.2, -1.0, 0.5, 0.5]),
}
STEP = 1e-6


@pytest.fixture(params=ARMS)
def arm_and_angles(request):
    tool, posture = ARMS[request.param]
    random = np.random.default_rng(1)
    angles = posture + random.uniform(-0.1, 0.1, (3, len(posture)))
    return load_arm(request.param, tool), angles


def test_a_skeleton_goes_from_the_base_over_the_joints_to_the_tool(arm_and_angles):
    """Rotating a joint leaves where it and those before it are; the tool is where it is."""
    arm, angles = arm_and_angles
    points = arm.skeleton(angles)
    joints = len(arm.joints)
    assert points.shape == (3, joints + 2, 3) and not points[:, 0].any()
    assert np.allclose(points[:, -1], arm.forward(angles)[:, :3, 3])
    for joint in np.flatnonzero(~arm.slides):
        moved = arm.skeleton(angles + 0.3 * (np.arange(joints) == joint))
        assert np.allclose(moved[:, : joint + 2], points[:, : joint + 2])
    assert not np.allclose(arm.skeleton(angles + 0.3)[:, 2:], points[:, 2:], atol=0.01)


def test_jacobians_by_joints_and_placements_are_the_derivatives_of_poses(arm_and_angles):
    """A placement moves along the axes of what it places."""
    arm, angles = arm_and_angles
    poses, by_joint, by_placement = arm.forward_and_all_jacobians(angles)
    assert np.array_equal(poses, arm.forward(angles))
    joints = len(arm.joints)
    assert by_placement.shape == (3, 6, 6 * (joints + 1))

    def slopes(ahead, behind):
        """(n, 6) m and rad along the base's axes."""
        turns = [pin.log3(a[:3, :3] @ b[:3, :3].T) for a, b in zip(ahead, behind, strict=True)]
        return np.concatenate([(ahead - behind)[:, :3, 3], turns], axis=1) / (2 * STEP)

    for joint in range(joints):
        step = STEP * (np.arange(joints) == joint)
        found = slopes(arm.forward(angles + step), arm.forward(angles - step))
        assert np.allclose(by_joint[..., joint], found, atol=1e-7)
    for number in range(6 * (joints + 1)):
        placed, axis = divmod(number, 6)
        moved = []
        for sign in (1, -1):
            other = arm.copy()
            motion = pin.exp6(pin.Motion(sign * STEP * np.eye(6)[axis]))
            if placed < joints:
                other.model.jointPlacements[placed + 1] *= motion
            else:
                other.model.frames[tool_frame(other.model, arm.tool)].placement *= motion
            moved.append(other.forward(angles))
        assert np.allclose(by_placement[..., number], slopes(*moved), atol=1e-7)
