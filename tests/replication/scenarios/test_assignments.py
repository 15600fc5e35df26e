import numpy as np
import pytest

from recalib import apply, orientation_error, position_error
from recalib.numerics import generator
from replication.config import PaperDamage, Published
from replication.scenarios import Ways, assign, compare

LINKS = ["upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link"]


def test_the_paper_allows_5760_different_assignments(robot):
    ways = Ways(LINKS, [0.01, 0.01, 0.04], robot.joints, np.radians([4, 3, 4]))
    assert (len(ways.short), len(ways.shifted), len(ways)) == (12, 480, 5760)
    assert len({ways[index] for index in range(len(ways))}) == 5760


def test_an_assignment_lists_its_damages_from_the_base_to_the_tool(robot):
    ways = Ways(LINKS, [0.01, 0.04], robot.joints, [0.05, 0.06])
    for index in range(0, len(ways), 37):
        links, joints = ways[index][:2], ways[index][2:]
        assert LINKS.index(links[0].link) < LINKS.index(links[1].link)
        assert robot.joints.index(joints[0].encoder) < robot.joints.index(joints[1].encoder)


@pytest.fixture(scope="module")
def assigned(plan):
    published = Published(position_error_cm=5.0, orientation_error_deg=3.0)
    damage = PaperDamage.model_construct(
        shorten=(0.01, 0.04), shift=(0.05,), published=published, poses=10
    )
    return damage, *assign(plan.nominal("ur10"), damage, seed=1)


def test_every_row_has_the_errors_of_its_damages(assigned, controller):
    damage, table, _ = assigned
    robot = controller.robot
    ways = Ways(LINKS, damage.shorten, robot.joints, damage.shift)
    assert len(table["distance"]) == len(ways) == 12 * 12
    poses = robot.workspace.sample(generator(1, "assignments"), 10)
    desired = robot.workspace.to_poses(poses)
    for index in range(0, len(ways), 29):
        achieved = apply(robot, ways[index]).forward(controller.inverse(desired))
        position = 100 * position_error(achieved, desired).mean()
        orientation = np.degrees(orientation_error(achieved, desired).mean())
        assert table["position_error_cm"][index] == pytest.approx(position)
        assert table["orientation_error_deg"][index] == pytest.approx(orientation)


def test_the_nearest_assignment_is_used(assigned, controller):
    damage, table, assignment = assigned
    ways = Ways(LINKS, damage.shorten, controller.robot.joints, damage.shift)
    assert assignment == ways[table["distance"].round(9).argmin()]


def test_the_distance_is_the_larger_relative_deviation(assigned, controller):
    damage, table, _ = assigned
    robot = controller.robot
    ways = Ways(LINKS, damage.shorten, robot.joints, damage.shift)
    poses = robot.workspace.sample(generator(1, "assignments"), 10)
    position, orientation, _ = (column[3] for column in table.values())
    exact = Published(position_error_cm=position, orientation_error_deg=orientation)
    off = Published(position_error_cm=position / 1.5, orientation_error_deg=orientation)
    small = Published(position_error_cm=position / 0.7, orientation_error_deg=orientation)
    found, nearest = compare(controller, ways, poses, exact)
    assert (found["distance"][3], nearest) == (0, 3)
    assert compare(controller, ways, poses, off)[0]["distance"][3] == pytest.approx(0.5)
    scaled, nearest = compare(controller, ways, poses, small, scale=0.7)
    assert scaled["distance"][3] == pytest.approx(0) and nearest == 3
