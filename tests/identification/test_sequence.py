"""Why rows do not fit is named: a lag, a drift, a jump, rows moved or exchanged; chance is not."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification import calibrate, identify_by_consensus
from recalib.identification.checks.outliers import exchanged
from recalib.identification.checks.sequence import DRIFT, GROWTH, JUMP, LAG, faults
from recalib.identification.model import ErrorModel, Frames, Optics
from tests.identification.honesty import AROUND, MIDDLE, ROWS, Session, with_targets
from tests.identification.real import NOISE, Real, geometry_of
from tests.laboratory.conftest import quick  # noqa: F401


@pytest.mark.parametrize(  # each pair of them at least once
    ("size", "on_a_path", "positions"),
    [(0.05, True, True), (0.05, False, False), (-0.02, True, False), (-0.02, False, True)],
)
def test_a_lag_is_named_by_its_size(size, on_a_path, positions, ur10):
    fault, *_ = Session(ur10, 1, LAG, size, positions, on_a_path).find_faults()
    assert fault.kind == LAG and fault.size == pytest.approx(size, rel=0.1)


@pytest.mark.parametrize("seed", range(8))
def test_a_jump_of_any_size_is_named_wherever_it_is_before_its_rows_are_outliers(seed, ur10):
    """From five deviations of the noise up to 80 mm and 3 degrees."""
    real, random = Real(ur10, seed), np.random.default_rng([seed, 8])
    count = int(random.integers(30, 60))
    first = int(random.integers(5, count - 4))
    joints = MIDDLE + random.uniform(-AROUND, AROUND, (count, 6))
    poses = real.poses(joints)
    size = np.exp(random.uniform(np.log(5 * NOISE[0]), np.log(0.08)))
    turn = random.integers(2) * np.exp(random.uniform(np.log(1e-3), np.log(np.radians(3))))
    motion = pin.SE3(pin.exp3(turn * np.eye(3)[1]), size * np.array([0.6, 0, 0.8])).homogeneous
    poses[first:] = motion @ poses[first:]
    observations = Observations(joints, poses if seed % 2 else poses[:, :3, 3])
    fault, *_ = faults(geometry_of(ur10, observations), observations)
    assert fault.kind == JUMP and abs(fault.row - first) <= 1


@pytest.mark.parametrize("positions", [True, False])
def test_an_arm_that_grows_as_it_warms_up_is_named_as_that(positions, ur10):
    real, random = Real(ur10, 3), np.random.default_rng(9)
    joints = MIDDLE + random.uniform(-AROUND, AROUND, (60, 6))
    poses = real.poses(joints)
    own = np.linalg.inv(real.base) @ poses
    own[:, :3, 3] *= 1 + 1e-3 * np.linspace(0, 1, 60)[:, None]
    poses = real.base @ own
    observations = Observations(joints, poses[:, :3, 3] if positions else poses)
    fault, *_ = faults(geometry_of(ur10, observations), observations)
    assert fault.kind == GROWTH and fault.size == pytest.approx(1e-3, rel=0.3)


TIMES = np.cumsum(np.random.default_rng(5).uniform(0.1, 3, ROWS))


@pytest.mark.parametrize(
    ("kind", "size", "on_a_path", "times"),
    [(LAG, 0.02, True, TIMES), (DRIFT, 1e-3, False, None), (DRIFT, 1e-3, False, TIMES**3)],
    ids=["lag", "drift by rows", "drift"],
)
def test_where_rows_carry_times_a_lag_is_in_seconds_and_a_drift_follows_the_clock(
    kind, size, on_a_path, times, ur10
):
    fault, *_ = Session(ur10, 5, kind, size, on_a_path=on_a_path, times=times).find_faults()
    assert fault.kind == kind and fault.size == pytest.approx(size, rel=0.2)


def test_a_lag_is_named_in_few_rows_and_no_jump_where_there_are_too_few(ur10):
    assert [fault.kind for fault in Session(ur10, 4, LAG, 0.05, rows=10).find_faults()] == [LAG]
    assert Session(ur10, 4, rows=10).find_faults() == []


def test_what_a_lag_explains_is_no_further_fault_and_what_it_hides_is_one(ur10):
    """A part of this one looks like a slip of the target, if the arm that it bends is believed."""
    session = Session(ur10, 4, LAG, 0.25, on_a_path=True)
    session.observations.measured[60:, 0, 3] += 0.01
    lag, jump = session.find_faults()
    assert (lag.kind, jump.kind) == (LAG, JUMP) and jump.size == pytest.approx(0.01, rel=0.1)


def test_what_several_targets_of_a_posture_share_is_no_fault(ur10):
    """Gears that no model holds move all targets of a posture: rows of it are one."""
    observations = with_targets(Real(ur10, 2, targets=3, gears=np.radians(0.03)), 40)
    geometry = geometry_of(ur10, observations)
    assert faults(geometry, observations) == []


@pytest.mark.parametrize("by_cameras", [True, False], ids=["a single picture", "a stopped clock"])
def test_where_no_time_passes_nothing_is_late_and_nothing_drifts(by_cameras, ur10):
    observations = Real(ur10, 1).observe(30, False)
    observations = replace(observations, times=np.zeros(30))
    if by_cameras:
        each = np.tile(np.eye(6), (30, 1, 1))
        optics = Optics(1e-8 * each, each[..., :0], each[:, :0, :0], each[:, 0, :0], each)
        second = np.arange(30) == 29
        observations = replace(observations, targets=second.astype(int), optics=optics, times=None)
    frames = Frames(targets=np.tile(np.eye(4), (2, 1, 1)))
    geometry = calibrate(ur10, (OFFSETS,), observations, frames)
    assert faults(geometry, observations) == []


@pytest.mark.slow
@pytest.mark.parametrize("on_a_path", [True, False], ids=["path", "random"])
def test_of_a_hundred_clean_arms_at_most_one_is_doubted(on_a_path, ur10):
    sessions = (
        Session(ur10, 1000 + seed, "", 0.0, bool(seed % 2), on_a_path, [30, 60, ROWS][seed % 3])
        for seed in range(100)
    )
    assert sum(bool(session.find_faults()) for session in sessions) <= 1


COUNT = 60


def measured(ur10, seed: int):
    """Joints and poses, and what may be drawn by chance."""
    random = np.random.default_rng([seed, 12])
    joints = MIDDLE + random.uniform(-AROUND, AROUND, (COUNT, 6))
    return joints, Real(ur10, seed).poses(joints), random


def calibrated(ur10, joints, poses, seed: int):
    observations = Observations(joints, poses if seed % 2 else poses[:, :3, 3])
    model = ErrorModel(ur10, OFFSETS, initial_frames(ur10, observations))
    return Calibration(model, identify_by_consensus(model, observations)), observations


@pytest.mark.parametrize("seed", range(6))
def test_rows_measured_from_elsewhere_are_named_with_the_motion(ur10, seed):
    joints, poses, random = measured(ur10, seed)
    first, count = int(random.integers(2, 40)), int(random.integers(5, 17))
    middle = poses[:, :3, 3].mean(axis=0)
    distance, turn = random.uniform(3e-3, 0.05), random.uniform(0, np.radians(1))
    turned = pin.exp3(turn * np.array([0, 0.6, 0.8]))
    motion = pin.SE3(turned, middle + distance * np.eye(3)[0] - turned @ middle).homogeneous
    rows = slice(first, first + count)
    poses[rows] = motion @ poses[rows]
    geometry, observations = calibrated(ur10, joints, poses, seed)
    (fault,) = faults(geometry, observations)
    assert (fault.kind, fault.row, fault.back) == (JUMP, first, first + count)
    assert fault.size == pytest.approx(distance, rel=0.15)
    assert fault.turn == pytest.approx(turn, abs=np.radians(0.15))
    assert exchanged(geometry, observations) is None


@pytest.mark.parametrize("seed", range(6))
def test_exchanged_rows_are_named_with_those_that_they_fit(ur10, seed):
    joints, poses, random = measured(ur10, seed)
    rows = random.choice(COUNT, int(random.integers(2, 11)), replace=False)
    others = np.roll(rows, 1)
    poses[rows] = poses[others]
    geometry, observations = calibrated(ur10, joints, poses, seed)
    found = exchanged(geometry, observations)
    assert dict(zip(found.rows, found.others, strict=True)) == dict(zip(rows, others, strict=True))


@pytest.mark.parametrize("seed", range(6))
def test_outliers_by_chance_have_no_cause(ur10, seed):
    """One after the other in half of the tables."""
    joints, poses, random = measured(ur10, seed)
    rows = slice(20, 26) if seed < 3 else random.choice(COUNT, 6, replace=False)
    poses[rows, :3, 3] += random.normal(0, 0.01, (6, 3))
    geometry, observations = calibrated(ur10, joints, poses, seed)
    assert faults(geometry, observations) == [] and exchanged(geometry, observations) is None
