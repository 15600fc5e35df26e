import numpy as np
import pytest

from recalib import JOINT_ERRORS, OFFSETS, Calibration, EccentricGear, Observations, apply
from recalib.identification import calibrate
from recalib.identification import calibration as module
from recalib.identification.model import held
from recalib.learners import angles_for
from tests.identification.test_estimation import postures


@pytest.fixture(scope="module")
def geared(controller):
    """Of an arm with an eccentric gear."""
    angles = postures(controller, 40)
    gear = apply(controller.robot, [EccentricGear("elbow_joint", 0.02)])
    return Observations(angles, gear.forward(angles))


@pytest.fixture(scope="module")
def calibrations(robot, geared):
    """Of two arms, with and without something left for a Gaussian process."""
    found = [calibrate(robot.arm, (terms,), geared) for terms in (OFFSETS, JOINT_ERRORS)]
    assert [calibration.pattern is None for calibration in found] == [False, True]
    return found


def test_the_angles_take_each_arm_to_its_poses_as_if_it_were_alone(controller, calibrations):
    """Also next to one that cannot reach its pose."""
    workspace = controller.robot.workspace
    commands = workspace.sample(np.random.default_rng(2), 2, 5)
    poses, start = workspace.to_poses(commands), controller.targets(commands).angles
    together = angles_for(calibrations, poses, start)
    for calibration, own, first, angles in zip(calibrations, poses, start, together, strict=True):
        assert np.allclose(calibration.forward(angles), own, atol=1e-8)
        assert np.array_equal(angles_for([calibration], own[None], first[None])[0], angles)
    poses[0, :, :3, 3] += 5.0  # m
    angles = angles_for(calibrations, poses, start)
    assert np.all(np.isfinite(angles))
    assert np.allclose(calibrations[1].forward(angles[1]), poses[1], atol=1e-8)


def test_a_pattern_is_learned_from_so_many_rows_at_most(robot, geared, monkeypatch):
    for most, used in ((40, 40), (30, 30)):
        monkeypatch.setattr(module, "MOST", most)
        inputs = calibrate(robot.arm, (OFFSETS,), geared).pattern.state()["inputs"]
        assert len(np.unique(inputs, axis=0)) == used
        assert {*map(tuple, inputs)} <= {*map(tuple, geared.joints)}


def test_what_no_process_explained_gets_none_from_a_few_more_rows(robot, geared):
    last = calibrate(robot.arm, (JOINT_ERRORS,), geared[:35])
    again = calibrate(robot.arm, (JOINT_ERRORS,), geared, last=last)
    assert last.pattern is None and again.pattern is None
    assert len(again.estimate.weights) == len(geared)


def test_a_restored_calibration_knows_which_joints_were_held(robot, geared):
    last = np.arange(6) == 5
    calibration = calibrate(robot.arm, (held(OFFSETS, last),), geared)
    again = Calibration.restore(robot.arm, calibration.state())
    assert np.array_equal(again.model.deviations, calibration.model.deviations)
    older = {name: value for name, value in calibration.state().items() if name != "deviations"}
    of_older = Calibration.restore(robot.arm, older).forward(geared.joints)
    assert np.array_equal(of_older, calibration.forward(geared.joints))
