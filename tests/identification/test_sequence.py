"""A lag, a drift and a jump are named, on paths and in random orders; clean arms are left alone."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from recalib.identification.calibration import Calibration
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.frames import UNKNOWN, Frames
from recalib.identification.initial_estimate import initial_frames
from recalib.identification.observations import Observations
from recalib.identification.sequence import DRIFT, JUMP, LAG, Fault, faults
from recalib.nominal.arms import load_arm
from tests.identification.honesty import with_targets
from tests.identification.real import Real

ROWS = 119
MIDDLE = np.radians([20, -65, 100, -40, 95, 10])
ERRORS = {"v": 1e-3, "w": np.radians(0.1), "offset": np.radians(1)}  # m, rad
NOISE = 2e-4, np.radians(0.02)


@pytest.fixture(scope="module")
def arm():
    return load_arm("ur10_robot.urdf", "tool0")


def postures(rng, rows: int, on_a_path: bool) -> np.ndarray:
    if not on_a_path:
        return MIDDLE + rng.uniform(-0.8, 0.8, (rows, 6))
    through = MIDDLE + rng.uniform(-0.8, 0.8, (max(rows // 6, 4), 6))
    return CubicSpline(np.linspace(0, 1, len(through)), through)(np.linspace(0, 1, rows))


def found(
    arm, seed: int, on_a_path: bool, kinds=2, rows=ROWS, lag=0.0, jump=0.0, drift=0.0, times=None
):
    """What is found in rows of a bent arm with these faults, in a lag of steps or of seconds."""
    rng, bent = np.random.default_rng(seed), ErrorModel(arm, OFFSETS)
    parameters = rng.standard_normal(len(bent.deviations)) * ERRORS["v"]
    bent.twists(parameters)[:, 3:] *= ERRORS["w"] / ERRORS["v"]
    parameters[bent.offset_columns] *= ERRORS["offset"] / ERRORS["v"]
    joints = postures(rng, rows, on_a_path)
    clock = np.arange(rows) if times is None else times
    speeds = np.diff(joints, axis=0, prepend=joints[:1])
    speeds[1:] /= np.diff(clock)[:, None]
    poses = bent.predict(parameters, joints - lag * speeds)
    where = rng.standard_normal(3)
    where /= np.linalg.norm(where)
    jumped = np.arange(rows) >= 2 * rows // 5
    poses[:, :3, 3] += np.outer(jump * jumped + drift * clock / clock[-1], where)
    poses[:, :3, 3] += NOISE[0] * rng.standard_normal((rows, 3))
    turns = Rotation.from_rotvec(NOISE[1] * rng.standard_normal((rows, 3))).as_matrix()
    poses[:, :3, :3] = turns @ poses[:, :3, :3]
    observations = Observations(joints, poses if kinds == 2 else poses[:, :3, 3], times=times)
    frames = Frames(
        base_unknown=True,
        targets_unknown=True,
        base_deviations=UNKNOWN,
        target_deviations=UNKNOWN,
    )
    model = ErrorModel(arm, OFFSETS, frames)
    estimate = identify(model, observations)
    return faults(Calibration(model, estimate), observations, estimate.weights > 0.1)


@pytest.mark.parametrize("kinds", [1, 2], ids=["positions", "poses"])
@pytest.mark.parametrize("on_a_path", [True, False], ids=["path", "random"])
@pytest.mark.parametrize("lag", [0.05, 0.01, -0.02])
def test_a_lag_is_named_by_its_part_of_a_step(lag, on_a_path, kinds, arm):
    fault, *_ = found(arm, 1, on_a_path, kinds, lag=lag)
    assert fault.kind == LAG and fault.size == pytest.approx(lag, rel=0.1)


@pytest.mark.parametrize("kinds", [1, 2], ids=["positions", "poses"])
@pytest.mark.parametrize("on_a_path", [True, False], ids=["path", "random"])
def test_a_jump_between_sessions_is_named_by_its_first_row(on_a_path, kinds, arm):
    (fault,) = found(arm, 2, on_a_path, kinds, jump=1e-3)
    assert fault.kind == JUMP and fault.size == pytest.approx(1e-3, rel=0.2)
    assert abs(fault.row - 2 * ROWS // 5) <= 1


def test_a_drift_is_named(arm):
    (fault,) = found(arm, 3, on_a_path=False, drift=1e-3)
    assert fault.kind == DRIFT and fault.size == pytest.approx(1e-3, rel=0.2)


def test_where_rows_carry_times_a_lag_is_named_in_seconds_and_a_drift_follows_the_clock(arm):
    times = np.cumsum(np.random.default_rng(5).uniform(0.1, 3, ROWS))
    (fault,) = found(arm, 5, on_a_path=True, lag=0.02, times=times)
    assert fault.kind == LAG and fault.size == pytest.approx(0.02, rel=0.1)
    (fault,) = found(arm, 6, on_a_path=False, drift=1e-3, times=np.arange(ROWS) ** 3.0)
    assert fault.kind == DRIFT and fault.size == pytest.approx(1e-3, rel=0.2)


def test_a_lag_is_named_in_few_rows_and_no_jump_where_there_are_too_few(arm):
    assert [fault.kind for fault in found(arm, 4, False, rows=10, lag=0.05)] == [LAG]
    assert found(arm, 4, on_a_path=False, rows=10) == []


def test_what_several_targets_of_a_posture_share_is_no_fault(arm):
    """Gears that no model holds move all targets of a posture: rows of it are one."""
    seen = with_targets(Real(arm, 2, targets=3, gears=np.radians(0.03)), 40)
    model = ErrorModel(arm, OFFSETS, initial_frames(arm, seen))
    estimate = identify(model, seen)
    assert faults(Calibration(model, estimate), seen, estimate.weights > 0.1) == []


@pytest.mark.slow
@pytest.mark.parametrize("on_a_path", [True, False], ids=["path", "random"])
def test_of_a_hundred_clean_arms_at_most_one_is_doubted(on_a_path, arm):
    sizes, kinds = [30, 60, ROWS], [1, 2]
    told: list[list[Fault]] = [
        found(arm, 1000 + seed, on_a_path, kinds[seed % 2], sizes[seed % 3]) for seed in range(100)
    ]
    assert sum(map(bool, told)) <= 1
