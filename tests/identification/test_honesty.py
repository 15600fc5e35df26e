"""What is said of an arm holds for postures that nobody measured."""

import numpy as np
import pytest

from recalib.identification.first_guess import guess_frames
from recalib.identification.observations import Observations
from recalib.identification.validation import GEOMETRIC, HYBRID, RANDOM, validate
from recalib.nominal.arms import load_arm
from tests.identification.bars import ARMS
from tests.identification.real import Real

GEARS = np.radians(0.03)
SOMEWHERE_ELSE = 400  # postures


def missed(calibration, seen):
    """Distances (n,) [m] between positions that are predicted and measured."""
    return np.linalg.norm(calibration.misses(seen)[:, :3], axis=1)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seed"), [("UR10", 3), ("UR10", 6), ("Panda", 2)])
def test_what_is_said_holds_where_a_posture_has_three_targets(name, seed):
    arm = load_arm(*ARMS[name])
    real = Real(arm, seed, targets=3, gears=GEARS)

    def seen_in(postures):
        joints, targets = np.repeat(real.postures(postures), 3, axis=0), np.arange(3 * postures) % 3
        return Observations(joints, real.poses(joints, targets)[:, :3, 3], targets)

    seen, fresh = seen_in(60), seen_in(200)
    found = validate(arm, seen, guess_frames(arm, seen))
    assert len(found.postures) == 60 and HYBRID in found.full
    for kind in (GEOMETRIC, HYBRID):
        said = found.errors(RANDOM, kind)[found.counted, 0].mean()
        assert said == pytest.approx(missed(found.full[kind], fresh).mean(), rel=0.2)


@pytest.mark.slow
def test_intervals_hold_where_nobody_measured():
    """20 arms are measured in one half of a joint's range and judged in the other."""
    arm, within = load_arm(*ARMS["UR10"]), []
    for seed in range(20):
        real = Real(arm, seed, gears=GEARS * (seed % 2))
        joints, halved = real.postures(4 * SOMEWHERE_ELSE), seed % len(arm.joints)
        upper = joints[:, halved] > np.median(joints[:, halved])
        here, there = joints[~upper][:60], joints[upper][:SOMEWHERE_ELSE]
        seen = Observations(here, real.poses(here))
        found = validate(arm, seen, guess_frames(arm, seen))
        errors = missed(found.calibration, Observations(there, real.poses(there)))
        within.append(np.mean(errors <= found.radii(there)))
    assert 0.9 <= np.mean(within) <= 0.99
    assert np.min(within) > 0.75
