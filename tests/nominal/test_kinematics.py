"""An arm's points and derivatives, beside finite differences."""

import numpy as np
import pytest

from recalib import load_arm

ARMS = {
    "ur10_robot.urdf": ("tool0", [0.0, -1.4, 2.1, -2.9, -1.6, 0.1]),
    "tiago.urdf": ("hand_tool_link", [0.2, 1.0, -0.5, 1.0, 1.2, -1.0, 0.5, 0.5]),
}


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
