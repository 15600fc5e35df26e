import numpy as np
import pytest

from recalib import InvalidSetting, UnknownName, UnsuitableRobot, load_arm, load_robot
from replication.scenarios import nominal_robot
from tests.arms import SCARA
from tests.conftest import changed

SIDES = [0.5, 0.6, 0.5], np.radians([40, 40, 40])


@pytest.mark.parametrize("name", ["ur10", "z1", "jaco", "puma560"])
def test_a_longer_tool_goes_on_outwards_along_the_axis_of_the_last_joint(name, plan):
    nominal = plan.nominal(name)
    short, long = (
        nominal_robot(changed(nominal, robot={"beyond": beyond})) for beyond in (0.0, 0.12)
    )
    _, jacobian = short.arm.forward_and_jacobian(short.home[None])
    moved = (long.workspace.centre - short.workspace.centre)[:3]
    assert np.allclose(moved[:, :3], 0, atol=1e-12), "it does not turn"
    assert np.allclose(np.abs(moved[:, 3] @ jacobian[0, 3:, -1]), 0.12)
    assert np.allclose(0.12 * short.workspace.centre[:3, :3] @ short.outward, moved[:, 3])
    wrist = short.arm.skeleton(short.home[None])[0, -2]
    ends = [np.linalg.norm(tool.workspace.centre[:3, 3] - wrist) for tool in (short, long)]
    assert ends[1] - ends[0] == pytest.approx(0.12)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"urdf": "ur11_robot.urdf"}, UnknownName, "ur10_robot.urdf"),
        ({"tool": "tool9"}, UnknownName, "tool0"),
        ({"tool": "world"}, UnsuitableRobot, "no joint of ur10_robot.urdf moves world"),
        ({"home": {"elbow": 0.0}}, UnknownName, "elbow_joint"),
        ({"home": {"elbow_joint": 0.0}}, InvalidSetting, "shoulder_pan_joint"),
        (
            {"limits": {"elbow_joint": (0.0, np.pi / 2)}},
            InvalidSetting,
            "elbow_joint is '120 deg'; expected: 0.0 deg to 90.0",
        ),
    ],
)
def test_an_impossible_robot_is_refused_with_what_would_be_valid(plan, change, error, message):
    with pytest.raises(error, match=message):
        nominal_robot(changed(plan.nominal("ur10"), robot=change))


def test_names_may_stand_in_any_order(robot):
    home = dict(zip(robot.joints, robot.home, strict=True))
    limits = {joint: (-3.0 - index, 3.0 + index) for index, joint in enumerate(robot.joints)}
    home, limits = (dict(reversed(values.items())) for values in (home, limits))
    loaded = load_robot(robot.urdf, "tool0", home, *SIDES, limits=limits)
    assert np.array_equal(loaded.home, robot.home)
    assert loaded.lower.tolist() == [-3, -4, -5, -6, -7, -8]
    assert loaded.upper.tolist() == [3, 4, 5, 6, 7, 8]


def test_the_home_of_a_joint_that_slides_is_a_length():
    arm = load_arm("tiago.urdf", "hand_tool_link")
    home = dict.fromkeys(arm.joints, 0.2) | {"torso_lift_joint": 0.5}
    with pytest.raises(InvalidSetting, match="joint is '500 mm'; expected: 0.0 mm to 350.0 mm"):
        load_robot("tiago.urdf", arm.tool, home, [0.01] * 3, [0.01] * 3)


def test_a_workspace_without_size_or_for_fewer_than_six_joints_is_refused(robot, tmp_path):
    home = dict(zip(robot.joints, robot.home, strict=True))
    with pytest.raises(InvalidSetting, match="above zero"):
        load_robot(robot.urdf, "tool0", home, [0, 0.6, 0.5], SIDES[1])
    (path := tmp_path / "scara.urdf").write_text(SCARA)
    home = dict.fromkeys(("shoulder", "elbow", "quill", "wrist"), 0.1)
    with pytest.raises(UnsuitableRobot, match="with 4 joints: .*; expected: at least six"):
        load_robot(path, "link_5", home, *SIDES)
