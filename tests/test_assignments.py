import numpy as np
import pytest

from recalib.damaged.damage import apply
from recalib.nominal.poses import orientation_error, position_error
from recalib.study.assignments import (
    damages_of,
    distance_to,
    enumerate_assignments,
    shifts,
    shortenings,
)

LINKS = ["upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link"]


def test_the_paper_allows_5760_assignments(robot):
    assert len(shortenings(LINKS, [0.01, 0.01, 0.04])) == 12
    assert len(shifts(robot.joints, np.radians([4, 3, 4]))) == 480
    assert len(set(shifts(robot.joints, np.radians([4, 3, 4])))) == 480


@pytest.fixture(scope="module")
def table(controller):
    poses = np.random.default_rng(0).uniform(-1, 1, (10, 6))
    return enumerate_assignments(controller, LINKS[:2], [0.01, 0.04], [0.05], poses), poses


def test_every_row_has_the_errors_of_its_damages(table, controller):
    frame, poses = table
    assert len(frame) == 2 * 12
    desired = controller.robot.workspace.to_poses(poses)
    for _, row in frame.iloc[::7].iterrows():
        damages = damages_of(row)
        assert len(damages) == 3
        achieved = apply(controller.robot, damages).forward(controller.inverse(desired))
        assert row["position_error_cm"] == pytest.approx(
            100 * position_error(achieved, desired).mean()
        )
        assert row["orientation_error_deg"] == pytest.approx(
            np.degrees(orientation_error(achieved, desired).mean())
        )


def test_the_distance_is_the_larger_relative_deviation(table):
    frame, _ = table
    row = frame.iloc[3]
    assert distance_to(frame, row["position_error_cm"], row["orientation_error_deg"])[3] == 0
    assert distance_to(frame, row["position_error_cm"] / 1.5, row["orientation_error_deg"])[
        3
    ] == pytest.approx(0.5)
