"""Lengths of links are compared wherever origins lie; those of another arm are refused."""

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from recalib import OFFSETS, Calibration
from recalib.identification.checks.diagnostics import Untrustworthy, check_links, link_lengths
from recalib.identification.model import ErrorModel
from tests.arms import RAILED, SCARA


def slid(arm, far: float):
    """The same arm, with other origins on all axes, and anywhere for a joint that slides [m]."""
    other, random = arm.copy(), np.random.default_rng(3)
    placements = other.model.jointPlacements
    for joint in range(1, len(arm.joints)):  # after the first: what is before it is the base's
        way = random.uniform(-far, far, 3 if arm.slides[joint] else 1) * arm.axes[joint]
        placements[joint + 1] = placements[joint + 1] * pin.SE3(np.eye(3), way)
        if joint + 2 <= len(arm.joints):
            placements[joint + 2] = pin.SE3(np.eye(3), -way) * placements[joint + 2]
    return other


def test_where_origins_lie_is_no_length(ur10, panda, load):
    for arm in (ur10, panda, load(SCARA), load(RAILED)):
        nominal, found = link_lengths(arm, slid(arm, 0.3))
        assert np.allclose(found, nominal, atol=1e-9)


def test_axes_that_are_nearly_parallel_explain_no_length(load):
    arm = load(SCARA)
    tilted = arm.copy()
    half = tilted.model.jointPlacements[2].translation / 2
    tilted.model.jointPlacements[2] = pin.SE3(pin.exp3(np.array([0, 1e-3, 0])), half)
    nominal, found = link_lengths(arm, tilted)
    assert found[0] == pytest.approx(nominal[0] / 2, abs=1e-3)


def changed(arm, link: int, parts) -> Calibration:
    """The arm whose link after a joint has grown by so many m along x, y and z."""
    parameters = np.zeros_like((model := ErrorModel(arm, OFFSETS)).deviations)
    model.twists(parameters)[link, :3] = parts
    return Calibration(model, SimpleNamespace(parameters=parameters))


def test_the_damage_of_the_paper_is_an_arm(ur10):
    for link in range(1, 6):
        for parts in 0.04 * np.concatenate([np.eye(3), -np.eye(3)]):
            check_links(changed(ur10, link, parts))


def test_another_arm_is_refused(ur10):
    with pytest.raises(
        Untrustworthy,
        match=r"between elbow_joint and wrist_1_joint is 4\d\d mm long by .* about 572 mm",
    ):
        check_links(changed(ur10, 3, -0.15 * ur10.model.jointPlacements[4].translation / 0.572))
