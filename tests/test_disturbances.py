import numpy as np
import pytest

from recalib.damaged.disturbances import Disturbances, Noise, Outliers, Repeatability
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
    measured = Disturbances(Noise(2e-4, 3e-4)).measure(generators(3), poses)
    assert np.std(measured[..., :3, 3]) == pytest.approx(2e-4, rel=0.05)
    angles = orientation_error(measured, poses)
    assert np.sqrt(np.mean(angles**2) / 3) == pytest.approx(3e-4, rel=0.05)


def test_outliers_are_as_many_and_as_far_as_asked_for():
    poses = np.tile(np.eye(4), (1, 4000, 1, 1))
    measured = Disturbances(outliers=Outliers(0.1, 0.05)).measure(generators(4), poses)
    misses = np.linalg.norm(measured[..., :3, 3], axis=-1)
    assert np.mean(misses > 0) == pytest.approx(0.1, rel=0.2)
    assert np.allclose(misses[misses > 0], 0.05)


def test_joints_stop_beside_their_angle():
    stops = Disturbances(repeatability=Repeatability(1e-4)).of_joints(generators(5, 6), 3000)
    assert stops.shape == (2, 3000, 6)
    assert np.std(stops) == pytest.approx(1e-4, rel=0.05)


def test_executing_is_disturbed_and_measuring_is_not(controller, damaged, commands):
    quiet = Plant(controller, [damaged])
    noisy = Plant(
        controller,
        [damaged],
        Disturbances(Noise(1e-3, 0.0), Repeatability(1e-3)),
        generators(7, 8),
    )
    assert np.array_equal(noisy.achieve(commands)[0], quiet.achieve(commands)[0])
    difference = noisy.execute(commands).achieved - quiet.execute(commands).achieved
    assert 1e-3 < np.abs(difference).mean() < 1e-1
    assert noisy.moves == quiet.moves == 40


def test_each_run_has_luck_of_its_own_that_repeats(controller, damaged, commands):
    same = np.repeat(commands[:1], 2, axis=0)
    disturbances = Disturbances(Noise(1e-3, 0.0))
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
    ("kind", "sizes", "message"),
    [
        (Noise, (-1e-4, 0.0), "Noise.position is -0.0001; valid: a finite number from 0 on"),
        (Noise, (0.0, np.nan), "Noise.orientation is nan"),
        (Repeatability, (np.inf,), "Repeatability.angle is inf"),
        (Outliers, (1.1, 0.05), "Outliers.share is 1.1; valid: from 0 to 1"),
        (Outliers, (0.1, -0.05), "Outliers.size is -0.05"),
    ],
)
def test_impossible_sizes_are_refused_by_name(kind, sizes, message):
    with pytest.raises(InvalidSetting, match=message):
        kind(*sizes)


def test_disturbances_are_gathered_from_their_parts():
    parts = [Outliers(0.1, 0.05), Noise(1e-3, 1e-4)]
    assert Disturbances.of(parts) == Disturbances(noise=parts[1], outliers=parts[0])
