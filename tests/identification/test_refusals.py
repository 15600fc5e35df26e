"""Rows, links and estimates of which no arm can be made are refused in a sentence that says why."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from recalib import OFFSETS, BadMeasurement, Calibration, Observations, RecalibError, initial_frames
from recalib.identification import identify
from recalib.identification.checks.diagnostics import (
    Untrustworthy,
    check_estimate,
    check_links,
    check_postures,
    link_lengths,
)
from recalib.identification.checks.postures import find_postures
from recalib.identification.model import ErrorModel
from tests.arms import RAILED, SCARA
from tests.identification.real import Real


@pytest.fixture(scope="module")
def model(ur10) -> ErrorModel:
    return ErrorModel(ur10, OFFSETS)


@pytest.fixture(scope="module")
def good(ur10) -> Observations:
    return Real(ur10, 3).observe(30, False)


def spoilt(values, bad):
    values = values.copy()
    values[7, 1] = bad
    return values


ROTATION = r"measurement 0 .*a rotation and a position, above"
WRONG = {  # a change of joints and poses, and the message
    "none": (lambda q, p: (q[:0], p[:0]), r"observations measured \(0\); expected: one or more"),
    "far joints": (lambda q, p: (spoilt(q, 14), p), r"angles of measurement 7 .*up to 12.6 \(rad"),
    "no joint": (lambda q, p: (spoilt(q, np.nan), p), r"joint angles of measurement 7 .*12\.6 \(r"),
    "a joint less": (lambda q, p: (q[:, :5], p), r"'joints' .*; expected: \(30, 6\)"),
    "half a pose": (lambda q, p: (q, p[:, :2]), r"\(30, 2, 4\); expected: \(30, 3\) or \(30, 4, 4"),
    "no pose": (lambda q, p: (q, spoilt(p, np.nan)), r"measurement 7 .*10 \(m in the base frame\)"),
    "mm": (lambda q, p: (q, 1e3 * p[:, :3, 3]), r"measurement 0 .*10 \(m in the base frame\)"),
    "transposed": (lambda q, p: (q, p.swapaxes(1, 2)), ROTATION),
    "mirrored": (lambda q, p: (q, p @ np.diag([-1, 1, 1, 1])), ROTATION),
    "scaled": (lambda q, p: (q, p @ np.diag([1.02] * 3 + [1])), ROTATION),
}


@pytest.mark.parametrize(("spoil", "message"), WRONG.values(), ids=WRONG)
def test_rows_that_are_no_observations(spoil, message, good, model):
    with pytest.raises(BadMeasurement, match=message):
        identify(model, Observations(*spoil(good.joints, good.measured)))


@pytest.mark.parametrize(
    ("measured", "message"),
    [
        (np.outer(np.arange(30.0), [0.1, 0.2, 0.3]), "the targets lie along a line, so the instr"),
        (np.tile(np.eye(4), (2, 1, 1)), "cannot be located from 2 rows; expected: at least 3"),
        (
            np.random.default_rng(1).normal(size=(30, 3)),
            "no pose of instrument and target fits the measurements: the smallest error is 1207 mm",
        ),
    ],
    ids=["a line", "two rows", "noise"],
)
def test_rows_that_place_no_instrument(measured, message, good, ur10):
    with pytest.raises(RecalibError, match=message):
        initial_frames(ur10, Observations(good.joints[: len(measured)], measured))


def test_a_joint_that_slides_farther_than_an_arm_does(load):
    joints = np.full((12, 7), 0.4)
    joints[3, 0] = 11.0
    model = ErrorModel(load(RAILED), OFFSETS)
    with pytest.raises(RecalibError, match=r"joint positions of measurement 3 .* up to 10 \(m\)"):
        identify(model, Observations(joints, np.zeros((12, 3))))


def test_nine_postures():
    joints = np.random.default_rng(2).uniform(-1, 1, (9, 6))
    found = find_postures(joints, np.zeros(6, dtype=bool), 0.0)
    with pytest.raises(RecalibError, match="9 rows of 9 postures; expected: at least 10 postures"):
        check_postures(found)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"converged": False}, "the identification of the geometry did not converge"),
        (
            {"noise": np.array([0.02, 0.1])},  # m, rad
            "the best fit are 20.0 mm and 5.7 deg along each .*; expected: up to 5 mm and 2 deg",
        ),
    ],
)
def test_an_estimate_that_says_little(change, message, good, model, ur10):
    observations = Observations(good.joints, ur10.forward(good.joints))
    calibration = Calibration(model, replace(identify(model, observations), **change))
    with pytest.raises(RecalibError, match=message):
        check_estimate(calibration, good)


def slid(arm, reach: float):
    """The same arm, with other origins on all axes, and anywhere for a joint that slides [m]."""
    other, random = arm.copy(), np.random.default_rng(3)
    placements = other.model.jointPlacements
    for joint in range(1, len(arm.joints)):  # after the first: what is before it is the base's
        shift = random.uniform(-reach, reach, 3 if arm.slides[joint] else 1) * arm.axes[joint]
        placements[joint + 1] = placements[joint + 1] * pin.SE3(np.eye(3), shift)
        if joint + 2 <= len(arm.joints):
            placements[joint + 2] = pin.SE3(np.eye(3), -shift) * placements[joint + 2]
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
    message = r"between elbow_joint and wrist_1_joint is 4\d\d mm long by .* about 572 mm"
    with pytest.raises(Untrustworthy, match=message):
        check_links(changed(ur10, 3, -0.15 * ur10.model.jointPlacements[4].translation / 0.572))
