"""What a user knows of frames and wear, and how well, decides what rows do not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import InvalidFile, load_correction, read_description
from recalib.laboratory.calibrate import calibrate_arm
from tests.laboratory.conftest import NOISE, postures, table, to_instrument, true_positions, write

ROWS = 40
INSTRUMENT = np.eye(4)  # in the arm's base
INSTRUMENT[:3] = [[0, 1, 0, -0.5], [-1, 0, 0, 1.0], [0, 0, 1, 0.2]]


def calibrated(arm, folder, text: str, part: float = 1.0):
    """From rows in a part of the joints' ranges, with a description."""
    joints = postures(3, ROWS, part)
    positions = true_positions(arm, joints)
    positions += NOISE * np.random.default_rng(4).standard_normal((ROWS, 3))
    write(folder / "known.csv", table(arm, joints, to_instrument(positions)))
    (folder / "known.toml").write_text(text)
    files = folder / "arm.urdf", folder / "known.csv", folder / "known.toml"
    return calibrate_arm(*files)


def of_instrument(shift: float, turn: float, within: str = "") -> str:
    """Its pose, off by so much [mm, deg] along and about each axis."""
    angles = Rotation.from_matrix(INSTRUMENT[:3, :3]).as_euler("xyz", degrees=True) + turn
    millimetres = 1e3 * INSTRUMENT[:3, 3] + shift
    lengths = [f"{number:.6f} mm{within and ' +- 3 mm'}" for number in millimetres]
    turns = [f"{angle:.6f} deg{within and ' +- 0.3 deg'}" for angle in angles]
    return f"[instrument]\nposition = {lengths}\nroll_pitch_yaw = {turns}\n"


def gap(result) -> float:
    """How far [mm] the instrument that is found is from where it is."""
    (place,) = [its for its in result.places if its.name == "the instrument"]
    return 1e3 * float(np.linalg.norm(place.pose[:3, 3] - INSTRUMENT[:3, 3]))


def test_a_frame_that_is_known_within_a_deviation_is_found_better(arm, folder, tmp_path):
    """The target is known, but for a link and a joint that move as it does."""
    known = '[target]\nposition = ["0 mm", "0 mm", "0 mm"]\n'
    result = calibrated(arm, folder, of_instrument(3.0, 0.0, "within") + known)
    assert gap(result) < 3 * np.sqrt(3) + 0.1
    (place,) = result.places
    assert place.deviations[0] < 3.2e-3 and place.real_deviations[0] < 10e-3
    unknown = calibrated(arm, folder, known)
    assert unknown.places[0].real_deviations[0] > 2 * place.real_deviations[0]

    result.correction.save(tmp_path / "correction.npz")
    again = load_correction(tmp_path / "correction.npz").calibration
    joints = result.data.observations.joints
    assert np.array_equal(again.forward(joints), result.calibration.forward(joints))


def test_what_is_stated_of_wear_bounds_what_rows_do_not_determine(arm, folder):
    exact = of_instrument(0.0, 0.0) + '[target]\nposition = ["0 mm", "0 mm", "0 mm"]\n'
    wear = '[wear]\nencoders = "0.5 deg"\nlinks = ["0.1 mm", "0.01 deg"]\n'
    model = calibrated(arm, folder, exact + wear).geometry.model
    assert model.deviations[model.offset_columns] == pytest.approx(np.radians(0.5))
    links = model.twists(model.deviations)[1:]
    assert links[:, :3] == pytest.approx(1e-4) and links[:, 3:] == pytest.approx(np.radians(0.01))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[target]\nposition = ["0 mm +- 0 mm", "0 mm", "0 mm"]', "expected: more than zero"),
        ('[target]\nposition = ["0 mm +- two", "0 mm", "0 mm"]', "expected: a length in mm"),
        ('[wear]\nencoders = "-1 deg"', "expected: more than zero"),
        ('[wear]\nlinks = "2 mm"', "expected: a length and an angle"),
        ('[wear]\ngears = "2 mm"', "expected: encoders = "),
    ],
)
def test_what_is_no_deviation_is_refused(text, said, tmp_path):
    (tmp_path / "known.toml").write_text(text)
    with pytest.raises(InvalidFile, match=said):
        read_description(tmp_path / "known.toml")
