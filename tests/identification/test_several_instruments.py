"""Several instruments that measure several targets: each row is of one sight."""

from dataclasses import replace

import numpy as np
import pytest

from recalib import OFFSETS, Arm, BadMeasurement, Calibration, Observations, initial_frames
from recalib.identification import calibrate, identify, joined_frames, parameters_of
from recalib.identification.model import ErrorModel, Frames, displacements
from tests.identification.honesty import distances
from tests.identification.real import Real, anywhere

SIGHTS = np.array([[0, 0], [1, 0], [1, 1]])
ELSEWHERE = anywhere(np.random.default_rng(9), 1.0)  # the first instrument, in the second one


class Cell:
    """Two instruments that see two targets, of which the first sees one only."""

    def __init__(self, arm: Arm, seed: int, gears: float = 0.0):
        self.arm, self.real = arm, Real(arm, seed, 2, gears)

    def observe(self, count: int, **noise) -> Observations:
        """Rows, so many of each sight."""
        joints, sights = self.real.postures(3 * count), np.repeat(np.arange(3), count)
        poses = self.real.poses(joints, SIGHTS[sights, 1], **noise)
        second = SIGHTS[sights, 0] == 1
        poses[second] = ELSEWHERE @ poses[second]
        return Observations(joints, poses, sights)

    def frames(self, observations: Observations) -> Frames:
        sights = (observations[observations.targets == sight] for sight in range(3))
        alone = [replace(rows, targets=0 * rows.targets) for rows in sights]
        return joined_frames([initial_frames(self.arm, rows) for rows in alone], SIGHTS)


def test_slopes_agree_with_finite_differences(ur10):
    rng = np.random.default_rng(1)
    bases, targets = ([anywhere(rng, 0.5) for _ in range(2)] for _ in range(2))
    unknown = {"base_unknown": True, "targets_unknown": True, "sights": SIGHTS}
    frames = Frames(bases[0], np.array(targets), further=np.array(bases[1:]), **unknown)
    model = ErrorModel(ur10, OFFSETS, frames)
    assert np.count_nonzero(model.free) == 4 * 6
    parameters = 0.1 * rng.standard_normal(len(model.deviations))
    joints, sights = rng.uniform(-1, 1, (6, 6)), np.arange(6) % 3
    poses, jacobians = model.linearise(parameters, joints, sights)
    assert np.allclose(poses, model.predict(parameters, joints, sights), atol=1e-12)
    found = model.found(parameters)
    own = model.own_arm(parameters).forward(model.standing(parameters, joints))
    composed = found.bases[SIGHTS[sights, 0]] @ own @ found.targets[SIGHTS[sights, 1]]
    assert np.allclose(composed, poses, atol=1e-12)
    for index, unit in enumerate(1e-5 * np.eye(len(parameters))):
        ends = (model.predict(parameters + sign * unit, joints, sights) for sign in (-1, 1))
        assert np.allclose(jacobians[..., index], displacements(*ends) / 2e-5, atol=1e-6)


def test_rows_of_all_sights_identify_one_arm(ur10):
    cell = Cell(ur10, 3)
    observations = cell.observe(20)
    model = ErrorModel(ur10, OFFSETS, cell.frames(observations))
    calibration = Calibration(model, identify(model, observations))
    fresh = cell.observe(60, noise=(0, 0))
    errors = np.linalg.norm(calibration.residuals(fresh)[:, :3], axis=1)
    assert errors.mean() < 1.5e-4  # m
    assert np.abs(calibration.frames.bases[1] - ELSEWHERE @ calibration.frames.base).max() < 2e-3
    again = Calibration.restore(ur10, calibration.state())
    assert np.array_equal(again.residuals(fresh), calibration.residuals(fresh))
    names = [parameter.name for parameter in parameters_of(model, calibration.estimate)]
    assert names[8 * 6] == "shift x of base to 1" and len(set(names)) == len(names)


def test_a_pattern_has_the_axes_of_the_instrument_that_measures(ur10):
    cell = Cell(ur10, 3, gears=np.radians(0.2))
    observations = cell.observe(80)
    calibration = calibrate(ur10, [OFFSETS], observations, cell.frames(observations))
    assert calibration.pattern is not None
    fresh, plain = cell.observe(60, noise=(0, 0)), replace(calibration, pattern=None)
    for sight in range(3):
        rows = fresh[fresh.targets == sight]
        errors = [distances(variant, rows).mean() for variant in (calibration, plain)]
        assert errors[0] < 0.85 * errors[1]


@pytest.mark.parametrize("sight", [-1, 3])
def test_a_sight_that_is_none_is_refused(ur10, sight):
    cell = Cell(ur10, 3)
    observations = cell.observe(10)
    frames = cell.frames(observations)
    observations.targets[4] = sight
    with pytest.raises(BadMeasurement, match="target of measurement 4"):
        identify(ErrorModel(ur10, OFFSETS, frames), observations)
