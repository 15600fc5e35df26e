"""Outliers that one cause explains are named by it; those by chance are not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification.checks.outliers import displaced, exchanged
from recalib.identification.consensus import identify_by_consensus
from recalib.identification.model.error_model import ErrorModel
from tests.identification.honesty import AROUND, MIDDLE
from tests.identification.real import Real

ROWS = 60


def measured(ur10, seed: int):
    """Joints and poses, and what may be drawn by chance."""
    random = np.random.default_rng([seed, 12])
    joints = MIDDLE + random.uniform(-AROUND, AROUND, (ROWS, 6))
    return joints, Real(ur10, seed).poses(joints), random


def calibrated(ur10, joints, poses, seed: int):
    seen = Observations(joints, poses if seed % 2 else poses[:, :3, 3])
    model = ErrorModel(ur10, OFFSETS, initial_frames(ur10, seen))
    return Calibration(model, identify_by_consensus(model, seen)), seen


@pytest.mark.parametrize("seed", range(6))
def test_rows_measured_from_elsewhere_are_named_with_the_motion(ur10, seed):
    joints, poses, random = measured(ur10, seed)
    first, count = int(random.integers(2, 40)), int(random.integers(5, 17))
    motion, middle = np.eye(4), poses[:, :3, 3].mean(axis=0)
    far, turn = random.uniform(3e-3, 0.05), random.uniform(0, np.radians(1))
    motion[:3, :3] = Rotation.from_rotvec([0, 0.6 * turn, 0.8 * turn]).as_matrix()
    motion[:3, 3] = middle + far * np.eye(3)[0] - motion[:3, :3] @ middle
    rows = slice(first, first + count)
    expected = np.linalg.norm((motion @ poses[rows])[:, :3, 3].mean(0) - poses[rows, :3, 3].mean(0))
    poses[rows] = motion @ poses[rows]
    geometry, seen = calibrated(ur10, joints, poses, seed)
    (run,) = displaced(geometry, seen)
    assert (run.first, run.last) == (first, first + count - 1)
    assert run.shift == pytest.approx(expected, rel=0.15)
    assert run.turn == pytest.approx(turn, abs=np.radians(0.15))
    assert exchanged(geometry, seen) is None


@pytest.mark.parametrize("seed", range(6))
def test_exchanged_rows_are_named_with_those_that_they_fit(ur10, seed):
    joints, poses, random = measured(ur10, seed)
    rows = random.choice(ROWS, int(random.integers(2, 11)), replace=False)
    others = np.roll(rows, 1)
    poses[rows] = poses[others]
    geometry, seen = calibrated(ur10, joints, poses, seed)
    found = exchanged(geometry, seen)
    assert dict(zip(found.rows, found.others, strict=True)) == dict(zip(rows, others, strict=True))


@pytest.mark.parametrize("seed", range(6))
def test_outliers_by_chance_have_no_cause(ur10, seed):
    """One after the other in half of the tables."""
    joints, poses, random = measured(ur10, seed)
    rows = slice(20, 26) if seed < 3 else random.choice(ROWS, 6, replace=False)
    poses[rows, :3, 3] += random.normal(0, 0.01, (6, 3))
    geometry, seen = calibrated(ur10, joints, poses, seed)
    assert displaced(geometry, seen) == [] and exchanged(geometry, seen) is None
