"""Where instrument and targets are, how well that is known, and that all files tell one story."""

import csv
import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import OFFSETS, Calibration, Observations, calibrate_arm, initial_frames, load_arm
from recalib.files import write_new
from recalib.identification import HYBRID, identify
from recalib.identification.checks.identifiability import unidentifiable_parameters
from recalib.identification.model import ErrorModel, displacements
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.places import found_places
from recalib.laboratory.report.folder import files_of
from tests.arms import INDUSTRIAL
from tests.identification.real import ARMS, Real
from tests.laboratory.conftest import table, write

URDF, TOOL = ARMS["UR10"]
DRAWS = 12


@pytest.mark.parametrize("text", [None, INDUSTRIAL], ids=["UR10", "industrial"])
@pytest.mark.parametrize("positions", [False, True], ids=["poses", "positions"])
def test_places_are_known_as_well_as_other_noise_moves_them(ur10, load, positions, text):
    arm = ur10 if text is None else load(text)
    real, guess, unidentifiable, drawn = Real(arm, 3), None, None, []
    joints = real.postures(40)
    for _ in range(DRAWS):
        poses = real.poses(joints)
        observations = Observations(joints, poses[:, :3, 3] if positions else poses)
        guess = guess or initial_frames(arm, observations)
        model = ErrorModel(arm, OFFSETS, guess)
        calibration = Calibration(model, identify(model, observations))
        unidentifiable = unidentifiable or unidentifiable_parameters(calibration, observations)
        drawn.append(found_places(calibration, unidentifiable, DataSet(observations), arm.tool))
    for found, truth in zip(
        zip(*drawn, strict=True), [np.linalg.inv(real.base), real.targets[0]], strict=True
    ):
        last = found[-1]
        moves = np.array([displacements(last.pose[None], one.pose[None])[0] for one in found])
        length, turn = moves.std(axis=0).reshape(2, 3).max(axis=1)
        assert 0.5 < last.deviations[0] / length < 2
        off = displacements(last.pose[None], truth[None])[0]
        assert 0.05 < np.linalg.norm(off[:3]) / last.real_deviations[0] < 2
        assert last.real_deviations[0] > 20 * last.deviations[0]
        if last.turned:
            assert 0.5 < last.deviations[1] / turn < 2
            assert np.linalg.norm(off[3:]) < 2 * last.real_deviations[1]
    assert [place.turned for place in drawn[0]] == [True, not positions]
    assert [(place.name, place.link) for place in drawn[0]] == [
        ("the instrument", arm.base),
        ("the target", arm.tool),
    ]


@pytest.fixture(scope="module")
def calibrated(ur10, tmp_path_factory):
    """With gears that no URDF holds, in 60 postures with two targets in each."""
    folder, real = tmp_path_factory.mktemp("places"), Real(ur10, 3, 2, np.radians(0.03))
    joints, numbers = np.repeat(real.postures(60), 2, axis=0), np.arange(120) % 2
    places = real.poses(joints, numbers)[:, :3, 3]
    targets = {"target": np.array(["left", "right"])[numbers]}
    write(folder / "m.csv", table(ur10, joints, places) | targets)
    result = calibrate_arm(URDF, folder / "m.csv", tool=TOOL)
    assert result.validation.chosen == HYBRID
    write_new(folder / "out", files_of(result))
    return result, folder / "out"


def test_urdf_parameters_and_frames_are_of_one_fit(calibrated):
    result, folder = calibrated
    values = json.loads((folder / "parameters.json").read_text())
    assert values["fit"] == "geometry, as in arm.urdf"
    observations = result.data.observations
    arm = load_arm(folder / "arm.urdf", values["tool"], values["base"])
    targets = np.array(list(values["targets_in_tool"].values()))[observations.targets]
    poses = np.array(values["base_in_instrument"]) @ arm.forward(observations.joints) @ targets
    predicted = result.geometry.predict(observations.joints, observations.targets)
    assert np.abs(poses - predicted).max() < 1e-9
    with (folder / "frames.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(row["frame"], row["in"]) for row in rows] == [
        ("the instrument", values["base"]),
        ("target left", values["tool"]),
        ("target right", values["tool"]),
    ]
    assert rows == [{k: str(v) for k, v in row.items()} for row in values["frames"]]
    instrument, left, _ = ([float(row[f"{axis} [mm]"]) for axis in "xyz"] for row in rows)
    base = np.linalg.inv(values["base_in_instrument"])
    assert np.allclose(instrument, 1e3 * base[:3, 3], atol=0.01)
    assert np.allclose(left, 1e3 * np.array(values["targets_in_tool"]["left"])[:3, 3], atol=0.01)
    instrument, left, _ = rows
    assert instrument["yaw [deg]"] and not left["yaw [deg]"] and not left["deviation [deg]"]
    deviation, real_deviation = "deviation [mm]", "deviation relative to the real link [mm]"
    assert 0 < float(left[deviation]) < 1 < float(left[real_deviation])


def test_an_arm_that_is_left_alone_may_have_an_offset_that_nothing_tells(ur10, tmp_path):
    real, turned = Real(ur10, 3), np.eye(4)
    joints = real.postures(40)
    turned[:3, :3] = Rotation.from_euler("z", 0.5, degrees=True).as_matrix()
    positions = (real.base @ turned @ ur10.forward(joints))[:, :3, 3] + real.random.normal(
        scale=5e-5, size=(40, 3)
    )
    write(tmp_path / "m.csv", table(ur10, joints, positions))
    result = calibrate_arm(URDF, tmp_path / "m.csv", tool=TOOL)
    instrument, _ = result.places
    assert not result.worthwhile and instrument.link == ur10.base
    off = np.linalg.norm((instrument.pose - np.linalg.inv(real.base))[:3, 3])
    assert instrument.deviations[0] < 1e-3 < off < 2 * instrument.real_deviations[0]
