"""What moves and measurements of a plant meet: noise, outliers, repeatability, and refusals."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import (
    BaseShift,
    Controller,
    Disturbances,
    InvalidSetting,
    Noise,
    Outliers,
    Plant,
    Repeatability,
    Sag,
    apply,
    load_robot,
    orientation_error,
)
from tests.arms import RAILED


def generators(*seeds) -> list[np.random.Generator]:
    return [np.random.default_rng(seed) for seed in seeds]


@pytest.fixture(scope="module")
def commands() -> np.ndarray:
    return np.random.default_rng(2).uniform(-1, 1, (2, 40, 6))


def test_noise_and_outliers_are_as_large_and_as_many_as_asked_for():
    poses = np.tile(np.eye(4), (1, 4000, 1, 1))
    measured = Disturbances(Noise(2e-4, 3e-4)).measure(generators(3), poses)
    assert np.std(measured[..., :3, 3]) == pytest.approx(2e-4, rel=0.05)
    angles = orientation_error(measured, poses)
    assert np.sqrt(np.mean(angles**2) / 3) == pytest.approx(3e-4, rel=0.05)
    measured = Disturbances(outliers=Outliers(0.1, 0.05)).measure(generators(4), poses)
    misses = np.linalg.norm(measured[..., :3, 3], axis=-1)
    assert np.mean(misses > 0) == pytest.approx(0.1, rel=0.2)
    assert np.allclose(misses[misses > 0], 0.05)


def test_two_disturbances_of_a_kind_are_refused():
    parts = Noise(1e-3, 0.0), Repeatability(1e-4)
    assert Disturbances.of(parts) == Disturbances(*parts)
    with pytest.raises(InvalidSetting, match="noise is 'there twice'; expected: once in a list"):
        Disturbances.of([*parts, Noise(2e-3, 0.0)])


def test_joints_stop_beside_their_angle():
    stops = Disturbances(repeatability=Repeatability(1e-4)).of_joints(generators(5, 6), (3000, 6))
    assert stops.shape == (2, 3000, 6)
    assert np.std(stops, axis=1) == pytest.approx(np.full((2, 6), 1e-4), rel=0.05)
    assert np.abs(np.corrcoef(stops[..., 0])[0, 1]) < 0.1, "each run with random numbers of its own"


def test_what_an_instrument_adds_does_not_depend_on_where_the_arm_stands():
    """It shifts along the base's axes and turns about them."""
    moved = np.tile(np.eye(4), (1, 5, 1, 1))
    moved[..., :3, :3] = Rotation.from_euler("xyz", [0.3, -0.8, 1.2]).as_matrix()
    moved[..., :3, 3] = 0.7, -0.2, 0.4
    disturbances = Disturbances(Noise(1e-3, 1e-1), outliers=Outliers(0.5, 0.05))
    added = []
    for poses in (np.tile(np.eye(4), (1, 5, 1, 1)), moved):
        measured = disturbances.measure(generators(3), poses)
        rotations = measured[..., :3, :3] @ poses[..., :3, :3].swapaxes(-1, -2)
        added.append((measured[..., :3, 3] - poses[..., :3, 3], rotations))
    for one, other in zip(*added, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)


def test_a_plant_stops_beside_its_poses_by_what_its_joints_do(controller, damaged, commands):
    loose = Disturbances(repeatability=Repeatability(1e-3))
    outcome = Plant(controller, damaged, loose, generators(7, 8)).execute(commands)
    stops = loose.of_joints(generators(7, 8), commands.shape[1:])
    angles = controller.targets(commands).angles + stops
    expected = damaged.forward(angles.reshape(-1, 6)).reshape(*commands.shape[:2], 4, 4)
    there = controller.robot.workspace.to_coordinates(expected)
    np.testing.assert_allclose(outcome.achieved, there, rtol=0, atol=1e-12)


def test_a_joint_that_slides_does_not_miss_its_place_by_an_angle(tmp_path, commands):
    path = tmp_path / "railed.urdf"
    path.write_text(RAILED)
    joints = "rail", "pan", "lift", "elbow", "bend", "twist", "turn"
    home = dict(zip(joints, [0.1, 0.0, -0.8, 1.4, 0.5, 0.3, 0.2], strict=True))
    controller = Controller(load_robot(path, "link_7", home, [0.05] * 3, [0.1] * 3), np.inf)
    stops = []

    class Arm:
        def forward(self, angles):
            stops.append(angles)
            return controller.robot.arm.forward(angles)

    plant = Plant(controller, Arm(), Disturbances(repeatability=Repeatability(1e-3)), generators(7))
    plant.execute(commands[:1])
    errors = stops[-1] - controller.targets(commands[:1]).angles[0]
    assert errors.std(axis=0) == pytest.approx([0, *[1e-3] * 6], rel=0.4)


def test_executing_is_disturbed_and_measuring_is_not(controller, damaged, commands):
    noise = Disturbances(Noise(1e-3, 0.0), Repeatability(1e-3))
    quiet = Plant(controller, damaged)
    noisy = Plant(controller, damaged, noise, generators(7, 8))
    assert np.array_equal(noisy.achieve(commands)[0], quiet.achieve(commands)[0])
    difference = noisy.execute(commands).achieved - quiet.execute(commands).achieved
    assert 1e-3 < np.abs(difference).mean() < 1e-1
    assert noisy.moves == quiet.moves == 40


def test_what_a_run_meets_is_of_its_own_generator_alone(controller, damaged, commands):
    disturbances = Disturbances(Noise(1e-3, 1e-3), Repeatability(1e-3), Outliers(0.5, 0.05))
    both = Plant(controller, damaged, disturbances, generators(9, 10)).execute(commands)
    alone = Plant(controller, damaged, disturbances, generators(10)).execute(commands[1:])
    assert np.array_equal(both.achieved[1:], alone.achieved)


@pytest.fixture
def few() -> np.ndarray:
    few = np.random.default_rng(3).uniform(-0.8, 0.8, (2, 3, 6))
    few[1, 2] = 50  # out of reach
    return few


def test_a_robot_for_each_run_does_what_it_does_alone(controller, damaged, few):
    for damage in BaseShift(translate=(0.01, 0.0, 0.02)), Sag("elbow_joint", 1e-3):
        arms = damaged, apply(controller.robot, [damage])
        together = Plant(controller, arms).execute(few)
        for run, arm in enumerate(arms):
            alone = Plant(controller, arm).execute(few[[run]])
            np.testing.assert_allclose(together.achieved[[run]], alone.achieved, atol=1e-12)
            assert np.array_equal(together.executed[[run]], alone.executed)


def test_moves_are_counted_with_those_that_were_refused_and_measuring_is_not(
    controller, damaged, few
):
    plant = Plant(controller, damaged)
    poses, executed = plant.achieve(few)
    assert plant.moves == plant.refused == 0
    home = damaged.forward(controller.robot.home[None])[0]
    assert np.argwhere(~executed).tolist() == [[1, 2]] and np.allclose(poses[1, 2], home)
    for _ in range(2):
        plant.execute(few)
    assert plant.moves == 6 and plant.refused.tolist() == [0, 2]
