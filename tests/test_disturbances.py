import numpy as np
import pytest

from recalib.damaged.disturbances import Disturbances
from recalib.damaged.plant import Plant
from recalib.errors import InvalidSetting
from recalib.nominal.poses import orientation_error


def generators(*seeds) -> list[np.random.Generator]:
    return [np.random.default_rng(seed) for seed in seeds]


@pytest.fixture(scope="module")
def commands() -> np.ndarray:
    return np.random.default_rng(2).uniform(-1, 1, (2, 40, 6))


def test_noise_has_the_size_that_was_asked_for():
    poses = np.tile(np.eye(4), (1, 4000, 1, 1))
    measured = Disturbances(position_noise=2e-4, orientation_noise=3e-4).measure(
        generators(3), poses
    )
    assert np.std(measured[..., :3, 3]) == pytest.approx(2e-4, rel=0.05)
    angles = orientation_error(measured, poses)
    assert np.sqrt(np.mean(angles**2) / 3) == pytest.approx(3e-4, rel=0.05)


def test_outliers_are_as_many_and_as_far_as_asked_for():
    poses = np.tile(np.eye(4), (1, 4000, 1, 1))
    measured = Disturbances(outlier_fraction=0.1, outlier_size=0.05).measure(generators(4), poses)
    misses = np.linalg.norm(measured[..., :3, 3], axis=-1)
    assert np.mean(misses > 0) == pytest.approx(0.1, rel=0.2)
    assert np.allclose(misses[misses > 0], 0.05)


def test_joints_stop_beside_their_angle():
    stops = Disturbances(repeatability=1e-4).of_joints(generators(5, 6), 3000)
    assert stops.shape == (2, 3000, 6)
    assert np.std(stops) == pytest.approx(1e-4, rel=0.05)


def test_executing_is_disturbed_and_measuring_is_not(controller, damaged, commands):
    quiet = Plant(controller, [damaged])
    noisy = Plant(
        controller,
        [damaged],
        Disturbances(position_noise=1e-3, repeatability=1e-3),
        generators(7, 8),
    )
    assert np.array_equal(noisy.achieve(commands)[0], quiet.achieve(commands)[0])
    difference = noisy.execute(commands).achieved - quiet.execute(commands).achieved
    assert 1e-3 < np.abs(difference).mean() < 1e-1
    assert noisy.moves == quiet.moves == 40


def test_each_run_has_luck_of_its_own_that_repeats(controller, damaged, commands):
    same = np.repeat(commands[:1], 2, axis=0)
    disturbances = Disturbances(position_noise=1e-3)
    first, second = (
        Plant(controller, [damaged], disturbances, generators(9, 10)).execute(same).achieved
        for _ in range(2)
    )
    assert np.array_equal(first, second)
    assert np.all(first[0, :, :3] != first[1, :, :3])


def test_no_disturbance_at_all_changes_nothing(controller, damaged, commands):
    quiet = Plant(controller, [damaged]).execute(commands).achieved
    still = (
        Plant(controller, [damaged], Disturbances(), generators(11, 12)).execute(commands).achieved
    )
    assert np.allclose(still, quiet, atol=1e-12)


@pytest.mark.parametrize(
    "setting",
    [
        {"position_noise": -1e-4},
        {"outlier_fraction": 1.1},
        {"repeatability": np.nan},
        {"outlier_size": np.inf},
    ],
)
def test_impossible_sizes_are_refused_by_name(setting):
    with pytest.raises(InvalidSetting, match=next(iter(setting))):
        Disturbances(**setting)
