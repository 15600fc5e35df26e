from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from recalib import InvalidSetting, UnknownName, Workspace, orientation_error, position_error
from recalib.nominal import COORDINATES, pose_errors

CENTRE = np.eye(4)
CENTRE[:3, :3] = Rotation.from_euler("xyz", [2.0, -0.7, 1.1]).as_matrix()
CENTRE[:3, 3] = 0.7, -0.2, 0.4
HALF_RANGES = np.array([0.25, 0.3, 0.25, 0.35, 0.35, 0.35])
WORKSPACE = Workspace(CENTRE, HALF_RANGES)
both = pytest.mark.parametrize(
    "workspace",
    [Workspace(CENTRE, HALF_RANGES, numbers) for numbers in COORDINATES],
    ids=list(COORDINATES),
)
coordinates = arrays(float, (5, 6), elements=st.floats(-2, 2))
vectors = arrays(float, 3, elements=st.floats(-1, 1))


@both
@given(u=coordinates)
def test_coordinates_survive_the_round_trip(workspace, u):
    assert np.allclose(workspace.to_coordinates(workspace.to_poses(u)), u, atol=1e-12)


@pytest.mark.parametrize(
    ("numbers", "turn"),
    [
        ("roll_pitch_yaw", lambda angles: Rotation.from_euler("xyz", angles)),
        ("rotation_vector", Rotation.from_rotvec),
    ],
)
@given(vectors=arrays(float, (5, 3), elements=st.floats(-7, 7)))
def test_orientations_are_those_of_scipy(numbers, turn, vectors):
    workspace = Workspace(np.eye(4), np.ones(6), numbers)
    poses = workspace.to_poses(np.pad(vectors, ((0, 0), (3, 0))))
    np.testing.assert_allclose(poses[:, :3, :3], turn(vectors).as_matrix(), rtol=0, atol=1e-12)
    again = turn(workspace.to_coordinates(poses)[:, 3:]).as_matrix()
    np.testing.assert_allclose(again, poses[:, :3, :3], rtol=0, atol=1e-12)


def test_a_turn_next_to_half_a_turn_is_read_to_the_last_digits():
    workspace = Workspace(np.eye(4), np.ones(6), "rotation_vector")
    turned = np.array([[0, 0, 0, 0.6, 0, 0.8]]) * (np.pi - 1e-12)
    again = workspace.to_coordinates(workspace.to_poses(turned))
    np.testing.assert_allclose(again, turned, rtol=0, atol=1e-11)


def test_the_centre_has_zero_coordinates_and_the_axes_are_those_documented():
    assert np.allclose(WORKSPACE.to_poses(np.zeros((1, 6)))[0], CENTRE)
    u = np.array([[1.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 1], [0, 0, 0, 1, 1, 1]])
    pose = WORKSPACE.to_poses(u)
    assert np.allclose(pose[0, :3, 3] - CENTRE[:3, 3], [0.25, 0, 0])
    yaw = Rotation.from_rotvec([0, 0, 0.35]).as_matrix()
    assert np.allclose(pose[1, :3, :3], CENTRE[:3, :3] @ yaw)
    x, y, z = (Rotation.from_rotvec(0.35 * axis).as_matrix() for axis in np.eye(3))
    assert np.allclose(pose[2, :3, :3], CENTRE[:3, :3] @ z @ y @ x)
    sample = WORKSPACE.sample(np.random.default_rng(0), 1000)
    assert sample.shape == (1000, 6)
    assert sample.min() >= -1 and sample.max() <= 1 and np.ptp(sample, axis=0).min() > 1.9


@pytest.mark.parametrize(
    ("numbers", "angles", "most"),
    [
        ("roll_pitch_yaw", [10, 90, 10], "a pitch below 90 deg"),
        ("roll_pitch_yaw", [180, 10, 10], "roll and yaw below 180 deg"),
        ("rotation_vector", [105, 105, 105], "a diagonal below 180 deg"),
    ],
)
def test_a_workspace_in_which_orientations_have_several_coordinates_is_refused(
    numbers, angles, most
):
    def box(angles):
        return Workspace(CENTRE, np.array([0.1, 0.1, 0.1, *np.radians(angles)]), numbers)

    with pytest.raises(InvalidSetting, match=f"half_ranges of orientation is .*{most}"):
        box(angles)
    workspace = box(0.98 * np.array(angles))
    corners = np.array([*product((-1, 1), repeat=6)], dtype=float)
    again = workspace.to_coordinates(workspace.to_poses(corners))
    np.testing.assert_allclose(again, corners, rtol=0, atol=1e-9)


@given(vectors, vectors, st.floats(0.001, 3.1))
def test_errors_measure_a_known_displacement(offset, axis, angle):
    if np.linalg.norm(axis) < 1e-3:
        axis = np.array([0, 0, 1.0])
    moved = CENTRE.copy()
    moved[:3, 3] += offset
    turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
    moved[:3, :3] = turn.as_matrix() @ CENTRE[:3, :3]
    assert position_error(moved, CENTRE) == pytest.approx(np.linalg.norm(offset), abs=1e-12)
    assert orientation_error(moved[None], CENTRE[None])[0] == pytest.approx(angle, abs=1e-9)
    assert orientation_error(CENTRE[None], moved[None])[0] == pytest.approx(angle, abs=1e-9)


def test_an_error_is_a_distance_and_a_turn_or_a_mean_over_coordinates():
    desired = np.array([[0.1, -0.2, 0.3, 0.4, 0.5, 0.6]])
    off = np.array([[0.03, -0.04, 0.0, 0.02, -0.01, 0.06]])  # m and rad
    poses = [WORKSPACE.to_poses(u) for u in (desired + off / HALF_RANGES, desired)]
    position, orientation = pose_errors(WORKSPACE, *poses)
    assert position == pytest.approx(0.05)
    assert np.array_equal(orientation, orientation_error(*poses))
    position, orientation = pose_errors(WORKSPACE, *poses, error="coordinates")
    assert position == pytest.approx(0.07 / 3) and orientation == pytest.approx(0.09 / 3)
    with pytest.raises(UnknownName, match="error of a pose 'median'"):
        pose_errors(WORKSPACE, *poses, error="median")
    yaw = np.zeros((2, 6))
    yaw[:, 5] = np.array([-3.1, 3.1]) / HALF_RANGES[5]
    poses = [WORKSPACE.to_poses(u[None]) for u in yaw]
    _, orientation = pose_errors(WORKSPACE, *poses, error="coordinates")
    assert orientation == pytest.approx((2 * np.pi - 6.2) / 3)
