from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import Observations, initial_frames
from recalib.identification import (
    BLOCKWISE,
    FOLDS,
    GEOMETRIC,
    HYBRID,
    KINDS,
    NOTHING,
    RANDOM,
    WAYS,
    HeldOut,
    blocks,
    random_folds,
    validate,
)
from recalib.identification import validation as module
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.identification.checks.postures import find_postures, outside_of
from recalib.identification.model import Frames, Optics
from tests.identification.honesty import MIDDLE, distances
from tests.identification.real import Real

ROWS = 40


@pytest.fixture(scope="module")
def real(ur10):
    return Real(ur10, 1)


@pytest.fixture(scope="module")
def validation(ur10, real):
    """With an outlier in row 7."""
    observations = real.observe(ROWS)
    observations.measured[7, 2, 3] += 0.02
    return validate(ur10, observations, initial_frames(ur10, observations))


def test_what_is_said_holds_for_fresh_rows_and_one_grossly_off_does_not_count(real, validation):
    assert validation.chosen == GEOMETRIC
    errors = distances(validation.calibration, real.observe(200))
    reported = validation.held_out[RANDOM][GEOMETRIC].errors[validation.counted, 0]
    assert reported.mean() == pytest.approx(errors.mean(), rel=0.2)
    assert validation.held_out[RANDOM][NOTHING].errors[:, 0].mean() > 10 * reported.mean()
    assert np.mean(errors <= validation.radius) >= 0.9
    assert 0.9 <= validation.coverage(RANDOM) <= 0.98
    for way in WAYS:
        kinds = validation.held_out[way]
        assert kinds[HYBRID] is kinds[GEOMETRIC]
        assert all(np.argmax(kinds[kind].errors[:, 0]) == 7 for kind in KINDS[1:])
    assert np.flatnonzero(~validation.counted) == [7]
    assert validation.full[GEOMETRIC].estimate.weights[7] < 0.01


@pytest.mark.parametrize(("gain", "chosen"), [(6e-4, NOTHING), (1e-3, GEOMETRIC)])
def test_what_is_richer_must_be_better_by_two_standard_errors(gain, chosen, validation):
    folds = validation.held_out[BLOCKWISE][NOTHING].folds
    better = np.outer(0.01 - gain + 2.5e-3 * (-1.0) ** np.arange(ROWS), [0.6, 0.8, 0.0])
    errors = {kind: HeldOut(better, folds) for kind in KINDS}
    errors[NOTHING] = HeldOut(np.tile([0.006, 0.008, 0.0], (ROWS, 1)), folds)
    assert replace(validation, held_out={BLOCKWISE: errors}).chosen == chosen


def test_more_than_geometry_that_does_not_settle_is_left_out(ur10, monkeypatch):
    monkeypatch.setattr("recalib.identification.held_out.FOLDS", 2)  # the choice alone matters
    real = Real(ur10, 7)
    joints = real.postures(ROWS)
    observations = Observations(joints, real.poses(joints + 0.01 * np.sin(joints)))
    frames = initial_frames(ur10, observations)
    found = validate(ur10, observations, frames)
    assert found.chosen == HYBRID and not found.unsettled

    def unconverged(calibration):
        return replace(calibration, estimate=replace(calibration.estimate, converged=False))

    def stopped(*arguments):
        geometry, *richer = calibrations(*arguments)
        return [geometry, *map(unconverged, richer)]

    calibrations = module.calibrations
    monkeypatch.setattr(module, "calibrations", stopped)
    found = validate(ur10, observations, frames)
    assert found.chosen == GEOMETRIC and found.unsettled


def postures_of(joints):
    return find_postures(joints, np.zeros(joints.shape[1], dtype=bool), 1e-4)


def test_each_target_and_each_socket_is_in_all_random_parts():
    joints = np.random.default_rng(2).uniform(-1, 1, (60, 6))
    numbers, postures = np.arange(60) % 3, postures_of(joints)
    for observations in (
        Observations(joints, joints[:, :3], numbers),
        Observations(joints, sockets=numbers),
    ):
        for number in range(3):
            folds = random_folds(observations, postures)
            assert set(folds[numbers == number]) == set(range(FOLDS))
        assert np.ptp(np.bincount(folds)) <= 1


@pytest.mark.parametrize("divide", [random_folds, blocks])
def test_a_posture_is_held_out_with_all_its_targets_and_repetitions(divide):
    random = np.random.default_rng(2)
    joints = np.repeat(random.uniform(-1, 1, (12, 6)), 5, axis=0)
    joints[1::5, 5] += 2 * np.pi  # a full turn of the last joint leads to the same place
    postures = postures_of(joints + 2e-5 * random.standard_normal(joints.shape))
    assert np.array_equal(postures.numbers, np.repeat(np.arange(12), 5))
    folds = divide(Observations(joints, joints[:, :3], np.arange(60) % 5), postures)
    assert (folds.reshape(12, 5) == folds[::5, None]).all()
    assert set(folds) == set(range(FOLDS))


def test_full_turns_alone_are_moves_and_paths_of_small_steps_many_postures():
    joints = np.array([[0.1, 0.2, 0.3], [0.1 + 2 * np.pi, 0.2, 0.3 + 2 * np.pi]])
    slides = np.array([False, False, True])
    assert find_postures(joints[:, :2], slides[:2], 1e-4).numbers.tolist() == [0, 0]
    found = find_postures(joints, slides, 1e-4)
    assert found.numbers.tolist() == [0, 1] and found.still.tolist() == [False, True, False]
    few = np.outer([0, 4e-4], [1, 1])  # rad turn less than the noise, m slide more
    assert find_postures(few, slides[1:], 1e-4).still.tolist() == [True, False]
    path = np.linspace(0, 1, 1000)[:, None] * np.ones(6)  # half the way to the next is alike
    numbers = postures_of(path).numbers
    assert 100 < numbers.max() < 1000 and (np.diff(numbers) >= 0).all()


def test_places_are_outside_of_a_range_along_its_own_axes_from_a_twentieth_on():
    turn = Rotation.from_euler("xyz", [0.3, -0.8, 1.2]).as_matrix()
    known = np.tile(np.eye(4), (8, 1, 1))
    known[:, :3, 3] = [*np.ndindex(2, 2, 2)] * np.array([1.0, 0.5, 0.25]) @ turn.T
    places = np.array([[1.04, 0.2, 0.1], [1.1, 0.2, 0.1], [1.3, -0.4, 0.1]]) @ turn.T
    assert outside_of(known, places)[:, 0] == pytest.approx([0, 0.1, 0.5])


def test_a_target_that_was_seen_in_one_region_alone_is_learned_in_all_parts():
    centres = np.repeat(np.eye(6)[:FOLDS], 8, axis=0)
    joints = centres + np.random.default_rng(3).normal(0, 0.01, (40, 6))
    targets = np.repeat([0, 1, 0], [16, 8, 16])
    folds = blocks(Observations(joints, joints[:, :3], targets), postures_of(joints))
    assert len(set(folds[targets == 1])) == FOLDS
    assert len(np.unique(folds[targets == 0].reshape(4, 8), axis=1).T) == 1
    joints = np.random.default_rng(4).uniform(-1, 1, (40, 6))
    units = np.array([1024, 1, 1, 1 / 1024, 1, 1])  # powers of two, which round nothing
    both = joints, joints * units
    assert np.array_equal(*(blocks(Observations(q, q[:, :3]), postures_of(q)) for q in both))


@pytest.mark.parametrize("count", [16, 30])
def test_a_third_of_the_rows_may_be_grossly_wrong(ur10, count):
    real = Real(ur10, count)
    observations = real.observe(count, positions=count > 16)
    bad = np.arange(count // 3) * 3
    observations.positions[bad] += 0.05 * np.array([0.6, -0.8, 0.0])
    found = validate(ur10, observations, initial_frames(ur10, observations))
    assert np.array_equal(np.flatnonzero(~found.counted), bad)
    assert real.error(found.calibration.predict) < 1e-3


@pytest.mark.parametrize("noise", [1e-3, 0.0])
def test_an_arm_without_errors_is_left_alone(ur10, noise):
    random = np.random.default_rng(4)
    joints = random.uniform(-1, 1, (30, 6))
    measured = ur10.forward(joints)[:, :3, 3] + random.normal(scale=noise, size=(30, 3))
    found = validate(ur10, Observations(joints, measured), Frames())
    assert found.chosen == NOTHING
    assert np.allclose(found.calibration.forward(joints), ur10.forward(joints), atol=1e-6)


def test_what_is_no_noise_is_refused_with_the_rows_to_look_at(ur10):
    real = Real(ur10, 5)
    observations = real.observe(30)
    shifts = real.random.standard_normal((30, 3))
    shifts *= 0.05 / np.linalg.norm(shifts, axis=1, keepdims=True)
    observations.measured[:, :3, 3] += shifts
    turn = Rotation.from_euler("x", 0.5, True).as_matrix()
    observations.measured[11, :3, :3] = turn @ observations.measured[11, :3, :3]
    message = r"the best fit are [0-9.]+ mm .*rows 12, ([0-9]+, ){3}"
    with pytest.raises(Untrustworthy, match=message):
        validate(ur10, observations, initial_frames(ur10, observations))


def test_a_turn_of_one_rad_counts_as_half_a_metre_and_the_worst_part_decides():
    residuals = np.array([[0.003, 0.0, 0.004, 0.0, 0.1, 0.0], [0.0, 0.0, 0.0, 0.02, 0.0, 0.0]])
    held = HeldOut(residuals, np.arange(2))
    assert held.errors == pytest.approx(np.array([[0.005, 0.1], [0, 0.02]]))
    assert held.losses == pytest.approx([0.055, 0.01])
    assert HeldOut(residuals[:, :3], held.folds).losses == pytest.approx([0.005, 0])
    each, seen = np.tile(np.eye(6), (2, 1, 1)), [500.0] * 3 + [0.0] * 3  # px for each m and rad
    optics = Optics(each, each[..., :0], each[:, :0, :0], each[:, 0, :0], each * seen)
    by_camera = HeldOut(residuals, held.folds, optics, 0.012)
    assert by_camera.errors[:, 0] == pytest.approx([0.013, 0.012])
    errors, folds = np.tile(np.arange(100) + 1.0, 2), np.repeat([0, 1], 100)
    errors[folds == 1] *= 3
    held = HeldOut(errors[:, None] * [0.6, 0.8, 0.0], folds)
    assert held.radius() == pytest.approx(3 * 96)
    assert held.coverage() == pytest.approx((1.0 + 0.32) / 2)


@pytest.mark.parametrize(("rows", "rank"), [(12, 12), (19, 19), (40, 39), (99, 95), (100, 96)])
def test_of_so_many_rows_the_least_that_covers_95_percent_of_others_is_taken(rows, rank):
    """A further one is at most the k-th of n with a probability of k / (n + 1)."""
    errors = np.random.default_rng(1).permutation(rows) + 1.0
    held = HeldOut(errors[:, None] * [0.6, 0.8, 0.0], np.zeros(rows, dtype=int))
    assert held.radius() == pytest.approx(rank)


@pytest.mark.parametrize(("rows", "seed"), [(10, 0), (11, 0), (13, 2), (13, 3)])
def test_of_few_positions_errors_are_known_too(ur10, rows, seed):
    """Without most of the parts, and in some without all but one, directions are open."""
    joints = MIDDLE + np.random.default_rng(seed).uniform(-1, 1, (rows, 6))
    observations = Observations(joints, Real(ur10, seed).poses(joints)[:, :3, 3])
    found = validate(ur10, observations, initial_frames(ur10, observations))
    assert found.lost[BLOCKWISE].sum() > rows / 2
    assert np.isfinite([found.mean_error(way, NOTHING) for way in WAYS]).all()
    assert 0 <= found.coverage(BLOCKWISE) <= 1 and found.radius > 0
