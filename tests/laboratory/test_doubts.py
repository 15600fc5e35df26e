"""What makes a calibration doubtful, or is left out of it, stands in its first lines."""

import re
from dataclasses import replace
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import OFFSETS, Calibrated, Description, Observations, calibrate_arm, load_arm
from recalib.identification import BLOCKWISE, GEOMETRIC, HYBRID, RANDOM, WAYS, parameters_of
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.identification.checks.outliers import Exchanged
from recalib.identification.checks.scales import Scale
from recalib.identification.checks.sequence import DRIFT, JUMP, LAG, SLIP, Fault
from recalib.identification.model import ErrorModel, Frames
from recalib.laboratory.calibrate import identified
from recalib.laboratory.data_set import DataSet
from recalib.laboratory.report.doubts import doubts
from recalib.laboratory.report.summary import errors_table, summary
from tests.identification.real import Real
from tests.laboratory.conftest import MIDDLE, RANGE, calibrated_by, measured, postures, table, write

ROWS = 60
LATE = "try to measure at rest, or to synchronise both"
PARTS = "try rows 1 to 21 and 22 to 60 each by themselves"
MODEL = ErrorModel(load_arm("ur10_robot.urdf", "tool0"), OFFSETS)


def result(
    errors: dict, chosen: str = HYBRID, faults: tuple = (), times=None, parameters=None
) -> SimpleNamespace:
    """A calibration with these errors [m] by way and kind, and parameters of geometry."""
    size = len(MODEL.deviations)
    estimate = SimpleNamespace(
        parameters=np.zeros(size) if parameters is None else parameters, covariance=np.eye(size)
    )
    geometry = SimpleNamespace(model=MODEL, estimate=estimate)
    validation = SimpleNamespace(chosen=chosen, mean_error=lambda way, kind: errors[way, kind])
    nothing = dict.fromkeys(("mistake", "mistaken", "wrong_gain", "exchanged"))
    nothing |= {"scales": {}, "misplaced": [], "unseen": 0, "directions": []}
    return SimpleNamespace(
        validation=validation,
        faults=faults,
        data=DataSet(Observations(np.zeros((ROWS, 6)), times=times)),
        parameters=parameters_of(MODEL, estimate),
        frames=Frames(),
        geometry=geometry,
        **nothing,
    )


@pytest.mark.parametrize(
    ("away", "geometry", "message"),
    [
        (1.48e-3, 1.72e-3, "an error of 1.48 mm away from the measured postures, not 0.405 mm"),
        (0.7e-3, 1.72e-3, ""),
        (1.48e-3, 0.7e-3, ""),
    ],
)
def test_what_geometry_and_blocks_contradict_is_warned_of(away, geometry, message):
    errors = {(RANDOM, HYBRID): 0.405e-3, (BLOCKWISE, HYBRID): away, (RANDOM, GEOMETRIC): geometry}
    assert " ".join(doubts(result(errors))).startswith(message and f"Careful: expect {message}")
    assert bool([*doubts(result(errors))]) == bool(message)
    assert not [*doubts(result(errors, GEOMETRIC))]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("offset of wrist_1_joint", "would be {} deg; expected from wear: 4 deg"),
        ("turn z behind elbow_joint", "would be {} deg; expected from wear: 0.5 deg"),
        ("shift x of tool", "would be {} mm; expected from wear: 20 mm"),
        ("shift z of base", "would be {} mm; expected from wear: 50 mm"),
    ],
)
@pytest.mark.parametrize("deviations", [-4.0, 2.9])
def test_what_wear_does_not_do_is_doubted_by_name(name, message, deviations):
    names = [parameter.name for parameter in parameters_of(MODEL, result({}).geometry.estimate)]
    parameters = np.zeros(len(names))
    number = names.index(name)
    parameters[number] = deviations * MODEL.deviations[number]
    text = " ".join(doubts(result({}, GEOMETRIC, parameters=parameters)))
    value = re.search(r"[0-9.]+ (mm|deg)$", message)[0].split()[0]
    expected = f"the {name} {message.format(f'{deviations * float(value):.3g}')}"
    assert (expected in text) == (bool(text)) == (abs(deviations) > 3)


@pytest.mark.parametrize(("seed", "deviation"), [(0, None), (1, None), (2, 2e-3), (3, 2e-3)])
@pytest.mark.parametrize("off", ["instrument", "target", "nothing"])
def test_a_stated_frame_that_is_off_is_doubted_by_name(seed, off, deviation, ur10):
    """Errors of links may explain such rows as well as a tool that is elsewhere does."""
    real, random = Real(ur10, seed), np.random.default_rng(seed)
    joints = np.array([0, -1, 2, -2, -1.6, 0]) + random.uniform(-1, 1, (40, 6))
    poses = real.poses(joints)
    places = {"instrument": np.linalg.inv(real.base), "target": real.targets[0].copy()}
    shift = random.standard_normal(3)
    if off in places:
        places[off][:3, 3] += 0.02 * shift / np.linalg.norm(shift)
    stated = None if deviation is None else np.array([deviation] * 3 + [2e-3] * 3)
    known = Description({}, **places)
    if stated is not None:
        known = replace(known, instrument_deviations=3 * stated, target_deviations=stated)
        known = replace(known, **{f"{off}_deviations": stated} if off in places else {})
    data = DataSet(Observations(joints, poses if seed % 2 else poses[:, :3, 3]), known=known)
    text = " ".join(doubts(identified(ur10, data)))
    assert re.findall("the stated (.*?) seems to be", text) == [off] * (off in places)


def test_outliers_with_one_cause_are_told_by_their_rows():
    found = result({}, GEOMETRIC)
    found.faults = [Fault(JUMP, 5e-3, 20, np.radians(0.2), back=35)]
    found.exchanged = Exchanged(np.array([10, 11]), np.array([11, 10]))
    found.data = replace(found.data, doubts=["the lens of camera left is doubtful"])
    lens, elsewhere, order = doubts(found)
    assert lens == "Careful: the lens of camera left is doubtful."
    there = "the instrument or the base seems to have been 5 mm and 0.2 deg from its place"
    assert f"in rows 21 to 35, {there}" in elsewhere
    assert "the measurements of rows 11 and 12 fit the joints of rows 12 and 11" in order
    found.exchanged = Exchanged(np.arange(10), np.roll(np.arange(10), 1))
    assert "of 10 rows, such as 1, 2, 3, 4, 5 and 6 fit" in [*doubts(found)][-1]


@pytest.mark.parametrize(
    ("fault", "times", "message"),
    [
        (Fault(LAG, 0.05), None, f"poses seem to be 5 % of a step behind the joints; {LATE}"),
        (Fault(LAG, 1.0), None, f"poses seem to be 100 % of a step behind the joints; {LATE}"),
        (Fault(LAG, -0.01), None, f"poses seem to be 1 % of a step ahead of the joints; {LATE}"),
        (Fault(LAG, 0.0203), np.arange(ROWS), f"poses seem to be 20 ms behind the joints; {LATE}"),
        (
            Fault(DRIFT, 1e-3),
            None,
            "the instrument seems to drift by 1 mm from the first row to the last; try a shorter"
            " session, or a warmed-up instrument",
        ),
        (
            Fault(JUMP, 1e-3, 21),
            None,
            "between rows 21 and 22, the instrument or the base seems to have moved by 1 mm"
            f" and 0 deg; {PARTS}",
        ),
        (
            Fault(SLIP, 1e-3, 21, 0.01),
            None,
            "between rows 21 and 22, the target seems to have slipped on the tool by 1 mm and"
            f" 0.57 deg; {PARTS}",
        ),
    ],
)
def test_a_fault_is_told_with_its_rows_and_size(fault, times, message):
    (doubt,) = doubts(result({}, GEOMETRIC, (fault,), times))
    assert doubt == f"Careful: {message}."


@pytest.mark.parametrize(
    ("scale", "message"),
    [
        (Scale(1.02, 0.1), "positions in the table are 2.0 percent too small"),
        (Scale(0.9, 0.1), "positions in the table are 10.0 percent too large"),
        (Scale(1.02, 0.5), ""),
        (Scale(1.01, 0.1), ""),
    ],
)
def test_another_scale_is_told_where_it_explains_what_is_off(scale, message):
    found = result({}, GEOMETRIC)
    found.data = DataSet(Observations(np.zeros((ROWS, 6)), np.zeros((ROWS, 3))))
    found.scales = {"positions": scale}
    text = " ".join(doubts(found))
    assert message in text and bool(text) == bool(message)


@pytest.mark.parametrize(
    ("mirrored", "message"),
    [
        (False, "mistake, without which the URDF fits far better: the zero of elbow_joint"),
        (True, "residuals of the best fit are .*; likely: positions with a reversed"),
    ],
)
def test_a_mistake_that_a_fit_takes_for_errors_of_the_arm_is_named(mirrored, message, tmp_path):
    """In a small part of the workspace the frames make up for much of it."""
    arm, random = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng(0)
    joints = np.array([0, -1.4, 2.1, -2.2, -1.6, 0.3]) + random.uniform(-0.15, 0.15, (30, 6))
    poses = arm.forward(joints + random.normal(0, 0.01, 6))
    if mirrored:
        poses[:, 1, 3] *= -1
    else:
        joints[:, 2] -= np.pi / 2
    turns = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    columns = dict(zip(("qx", "qy", "qz", "qw"), turns.T, strict=True))
    write(tmp_path / "rows.csv", table(arm, joints, poses[:, :3, 3]) | columns)
    try:
        text = summary(calibrate_arm("ur10_robot.urdf", tmp_path / "rows.csv", tool="tool0"))
    except Untrustworthy as error:
        text = str(error)
    assert re.search(message, text)


@pytest.mark.parametrize("still", [[0], [2], [3, 4, 5], [0, 1, 4, 5]], ids=str)
def test_joints_that_stood_still_are_no_mistake(still, ur10):
    """Their own errors look like a column in another unit, or with another zero."""
    real, random = Real(ur10, 5), np.random.default_rng(5)
    joints = np.array([0, -1, 2, -2, -1.6, 0]) + random.uniform(-1, 1, (40, 6))
    joints[:, still] = joints[0, still]
    places = {"instrument": np.linalg.inv(real.base), "target": real.targets[0]}
    data = DataSet(Observations(joints, real.poses(joints)), known=Description({}, **places))
    assert identified(ur10, data).mistake is None


def test_rows_that_are_shifted_by_one_are_told_once(arm, folder):
    """Slow rows look as if poses lagged behind, too."""
    joints = MIDDLE + RANGE * np.sin(np.arange(ROWS)[:, None] * [0.31, 0.47, 0.23])
    with pytest.raises(Untrustworthy, match="likely: joints of the row") as refusal:
        calibrated_by(arm, folder, joints[1:], measured(arm, joints)[:-1])
    assert "of a step" not in str(refusal.value)


def two_sessions(arm, folder, rows: int, moved: list[float]) -> Calibrated:
    """Where the instrument moved by so much [m] after so many rows."""
    joints = postures(3, ROWS)
    positions = measured(arm, joints)
    positions[rows:] += moved
    return calibrated_by(arm, folder, joints, positions)


def test_two_sessions_are_told_of_beside_the_error(arm, folder):
    _, first, *_ = summary(two_sessions(arm, folder, 20, [6e-4, -6e-4, 5e-4])).splitlines()
    assert ": between rows 20 and 21, the instrument or the base seems to have moved by" in first
    words = "between rows 30 and 31, the instrument or the base seems to have moved by 50 mm"
    with pytest.raises(Untrustworthy, match=words):
        two_sessions(arm, folder, 30, [0.03, 0.0, -0.04])


def test_the_first_line_and_the_table_say_how_many_rows_are_left_out(arm, folder):
    joints = postures(3, ROWS)
    positions = measured(arm, joints)
    positions[[7, 30, 31, 44]] += np.random.default_rng(5).normal(0, 0.02, (4, 3))
    result = calibrated_by(arm, folder, joints, positions)
    text, errors = summary(result), errors_table(result)
    _, first, *lines = text.splitlines()
    assert f"4 of {ROWS} rows left out as outliers" in first
    (row,) = [line for line in lines if line.startswith("left out")]
    largest = errors[-1].largest
    assert "4 rows" in row and f"{largest:.3f}" in row and largest > 10
    # the radius of 95 percent is one number wherever it stands
    chosen = [row for row in errors if row.chosen and row.folds == BLOCKWISE]
    (used,) = [row for row in chosen if row.unit == "mm"]
    assert used.within == pytest.approx(1e3 * result.validation.radius)
    assert text.count(f"95 % within {used.within:.3g} mm") == 2


@mock.patch("recalib.identification.held_out.FOLDS", 5)
def test_a_part_without_which_a_direction_is_open_does_not_count(arm, folder):
    """All postures that turn the last joint are near one another."""
    joints = postures(3, ROWS)
    joints[:48, 1:] = joints[0, 1:] + 1e-3 * (joints[:48, 1:] - joints[0, 1:])
    joints[48:, 0] = 3 * np.sign(joints[48:, 0].mean()) + 0.1 * joints[48:, 0]
    result = calibrated_by(arm, folder, joints, measured(arm, joints))
    lost = {way: int(result.validation.lost[way].sum()) for way in WAYS}
    assert 0 < lost[BLOCKWISE] < ROWS
    assert f"errors {BLOCKWISE} exclude {lost[BLOCKWISE]} rows" in summary(result)
    assert len(result.counted) == ROWS - lost[BLOCKWISE]
