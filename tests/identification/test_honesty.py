"""What is said of an arm holds for postures that nobody measured."""

import numpy as np
import pytest

from recalib.identification.sequence import DRIFT, JUMP, LAG
from recalib.nominal.arms import load_arm
from tests.identification.honesty import Session, few_poses, other_half, three_targets
from tests.identification.real import ARMS


@pytest.mark.slow
@pytest.mark.parametrize("name", ARMS)
def test_what_is_said_holds_where_a_posture_has_three_targets(name):
    for said, true in three_targets(load_arm(*ARMS[name]), seed=0).values():
        assert said == pytest.approx(true, rel=0.2)


@pytest.mark.slow
def test_intervals_hold_where_nobody_measured():
    """20 arms are measured in one half of a joint's range and judged in the other."""
    arm = load_arm(*ARMS["UR10"])
    within = [other_half(arm, seed) for seed in range(20)]
    assert 0.9 <= np.mean(within) <= 0.99
    assert np.min(within) > 0.75


@pytest.mark.slow
def test_intervals_hold_where_postures_are_few():
    """By how far the parameters are known, with the noise found in so few, 70 % would be within."""
    within = [few_poses(load_arm(*ARMS["UR10"]), seed) for seed in range(8)]
    assert 0.9 <= np.mean(within) <= 0.99


@pytest.mark.slow
@pytest.mark.parametrize("positions", [True, False], ids=["positions", "poses"])
@pytest.mark.parametrize("on_a_path", [True, False], ids=["path", "random"])
@pytest.mark.parametrize(("kind", "size"), [(LAG, 0.01), (LAG, 0.05), (JUMP, 1e-3), (DRIFT, 1e-3)])
def test_a_fault_of_a_session_is_named_or_errors_are_honest(kind, size, on_a_path, positions):
    arm = load_arm(*ARMS["UR10"])
    for seed in (1, 5):
        session = Session(arm, seed, kind, size, positions, on_a_path)
        assert [fault.kind for fault in session.named()][:1] == [kind] or session.honesty() > 0.8
