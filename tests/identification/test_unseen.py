"""What rows do not determine stays as given, whatever small misfit would like it to be."""

import numpy as np
import pytest

from recalib import OFFSETS, Calibration, Observations, initial_frames
from recalib.identification import Unseen, identify
from recalib.identification.checks.identifiability import unidentifiable_parameters
from recalib.identification.model import ErrorModel
from tests.arms import urdf
from tests.identification.real import Real

ROWS, DROOP = 60, 2e-3  # rad, by which the links hang: no model here holds it
LIMIT = 5e-3  # m
DRILLING = urdf(
    ("turn", "revolute", "0 0 1", "0 0 0.4"),
    ("lift", "revolute", "0 1 0", "0.15 0 0"),
    ("reach", "revolute", "0 1 0", "0 0 0.6"),
    ("roll", "revolute", "1 0 0", "0.64 0 0.1"),
    ("pitch", "revolute", "0 1 0", "0 0 0"),
    ("spin", "revolute", "1 0 0", "0.1 0 0"),
    ("flange", "fixed", "0 0 1", "0.1 0 0"),
    mass=3.0,
)


def drilling(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Joints (n, 6) of rows in which the tool is upright, and of others."""
    random = np.random.default_rng(seed)
    joints = random.uniform(-0.7, 0.7, (2 * ROWS, 6))
    joints[:, [0, 5]] *= 2
    joints[:, 4] += np.pi / 2
    rows, others = joints[:ROWS], joints[ROWS:]
    rows[:, 3] = 0.0
    rows[:, 4] = np.pi / 2 - rows[:, 1] - rows[:, 2]
    return rows, others


@pytest.mark.parametrize("positions", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_the_length_of_a_tool_that_is_always_upright_stays_as_given(load, positions, seed):
    arm = load(DRILLING)
    real = Real(arm, seed)
    rows, others = drilling(seed)

    def poses(joints, noise):
        droop = np.zeros_like(joints)
        droop[:, 1], droop[:, 2] = np.sin(joints[:, 1]), np.cos(joints[:, 1] + joints[:, 2])
        return real.poses(joints + DROOP * droop, noise=noise)

    measured = poses(rows, (1e-4, 1e-4))
    observations = Observations(rows, measured[:, :3, 3] if positions else measured)
    frames = initial_frames(arm, observations, target=real.targets[0])
    model = ErrorModel(arm, OFFSETS, frames)
    found = Calibration(model, identify(model, observations))
    wear = found.estimate.parameters / model.deviations
    assert np.abs(wear[~model.free]).max() < 1.5
    open_now = [its for its in unidentifiable_parameters(found, observations) if not its.lasting]
    assert open_now, "other postures would tell, and that is said"
    gaps = found.predict(others) - poses(others, (0, 0))
    assert np.linalg.norm(gaps[:, :3, 3], axis=1).mean() < LIMIT


def test_rows_all_over_the_workspace_show_all_that_can_be_seen(ur10):
    observations = Real(ur10, 1).observe(30)
    model = ErrorModel(ur10, OFFSETS, initial_frames(ur10, observations))
    assert not Unseen(model, observations).directions.size
