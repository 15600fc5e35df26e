"""What is known of frames, sockets and wear, right or wrong: of a small arm, and of a Panda."""

import re
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import Calibrated, InvalidFile, InvalidSetting, calibrate_arm, load_correction
from recalib.identification.checks.diagnostics import Untrustworthy
from recalib.laboratory.plausibility.mistakes import Mistaken
from recalib.laboratory.propose import propose
from recalib.laboratory.report.summary import summary
from tests.arms import SCARA
from tests.laboratory.conftest import (
    NOISE,
    OFFSETS,
    ROWS,
    calibrated_by,
    in_degrees,
    in_millimetres,
    measured,
    postures,
    to_instrument,
    true_positions,
    write,
)

INSTRUMENT = '[instrument]\nposition = ["1 m", "0 m", "0 m"]\n'
TARGET = '[target]\nposition = ["0 mm", "0 mm", "50 mm"]\n'
POINT = 0, 0, 0.05, 1  # m
DISTANCE = '[[distance]]\nsockets = ["{}", "right"]\nlength = "{} mm"\n'


@pytest.fixture(scope="module")
def table(arm, folder):
    """Positions measured by an instrument at x = 1 m, and those of the nominal arm."""
    joints = postures(12)
    observed, nominal = (arm.forward(q) @ POINT - [1, 0, 0, 0] for q in (joints + OFFSETS, joints))
    observed[:, :3] += NOISE * np.random.default_rng(13).standard_normal((ROWS, 3))
    columns = in_degrees(arm, joints)
    columns |= {f"{axis} [m]": observed[:, index] for index, axis in enumerate("xyz")}
    write(folder / "known.csv", columns)
    columns |= {f"{axis}_nominal [m]": nominal[:, index] for index, axis in enumerate("xyz")}
    write(folder / "nominal.csv", columns)
    return folder / "known.csv"


def calibrated_with(text: str, table, arm=None, tool=None) -> Calibrated:
    """The small arm, or another one."""
    (path := table.parent / "description.toml").write_text(text)
    return calibrate_arm(arm or table.parent / "arm.urdf", table, path, tool=tool)


by_ball = partial(calibrated_with, arm="panda.urdf", tool="panda_hand_tcp")


def test_frames_that_are_known_leave_base_and_tool_to_the_arm(arm, table):
    result = calibrated_with(INSTRUMENT + TARGET, table)
    assert not result.frames.base_unknown and not result.frames.targets_unknown
    assert result.correction.unidentifiable_ends == "the rotation of the tool link"
    assert result.worthwhile
    tests = postures(14, 20, part=0.8)
    gap = (result.calibration.forward(tests) - arm.forward(tests + OFFSETS)) @ POINT
    assert np.linalg.norm(gap, axis=1).mean() < 3 * NOISE


@pytest.mark.parametrize("known", [INSTRUMENT, TARGET])
def test_one_frame_alone_may_be_known(known, table):
    result = calibrated_with(known, table.with_name("nominal.csv"))
    assert result.worthwhile
    unknown = result.frames.base_unknown, result.frames.targets_unknown
    assert unknown == (known == TARGET, known == INSTRUMENT)
    assert "a tool point at (0, 0, 50) mm" in result.offset
    assert "the base moved by (-1000, 0, 0) mm" in result.offset
    frames = result.calibration.frames
    assert np.allclose(frames.base[:3, 3], [-1, 0, 0], atol=0.02)
    assert np.allclose(frames.targets[0, :3, 3], POINT[:3], atol=0.02)


TURNED = f'{INSTRUMENT}roll_pitch_yaw = ["0 deg", "0 deg", "90 deg"]\n'
ELSEWHERE = TARGET.replace('"50 mm"', '"450 mm"')
INVERTED = INSTRUMENT.replace('"1 m"', '"-1 m"')


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (TURNED + TARGET, r"\[instrument\] is \d\d mm and 9\d deg .* position = \[\"999 mm\", "),
        (INVERTED + TARGET, r"\[instrument\] is 1999 mm and 1 deg from its estimate"),
        (INSTRUMENT + ELSEWHERE, r"\[target\] is 396 mm and 0 deg from its estimate"),
        (TURNED, r"\[instrument\] is \d\d mm and 9\d deg from"),
        (TARGET.replace('"0 mm"', '"700 mm"'), r"\[target\] is 9\d\d mm and 0 deg from"),
        (TURNED + ELSEWHERE, r"\[instrument\] and \[target\] is .* and is "),
    ],
    ids=["turned", "inverted", "target", "instrument alone", "target alone", "both"],
)
def test_a_frame_that_is_not_there_is_named(text, message, table):
    with pytest.raises(Mistaken, match=rf"the description's .*{message}"):
        calibrated_with(text, table)


def test_a_ball_in_sockets_needs_no_instrument_and_is_where_it_is_known_to_be(in_sockets):
    result = by_ball(DISTANCE.format("left", 300), in_sockets)
    one, other = result.calibration.frames.sockets
    assert np.linalg.norm(one - other) == pytest.approx(0.3, abs=1e-3)
    assert result.worthwhile and result.data.sockets == ("left", "right")
    text = summary(result)
    assert "errors are measured in the sockets" in text and "the instrument" not in text
    assert [place.name for place in result.places] == ["the target", "socket left", "socket right"]
    names = [row["name"] for row in result.identified]
    assert "x of socket left, from its initial estimate" in names and "socket 1" not in str(names)
    with pytest.raises(InvalidSetting, match="candidates is missing; expected: postures in which"):
        propose(result.correction, 3)
    assert result.correction.unidentifiable_ends == "the arm's base and the tool link"
    with pytest.raises(InvalidSetting, match="base: balls in sockets need no instrument"):
        result.correct(np.zeros(3), frame="instrument")
    known = by_ball('[target]\nposition = ["0 mm", "0 mm", "0 mm"]\n', in_sockets)
    assert np.array_equal(known.calibration.frames.targets[0], np.eye(4))


def test_a_range_beyond_the_limits_of_the_urdf_is_told(folder, calibrated):
    """The table's unit or zero may be another, and no command goes there."""
    narrow = folder / "narrow.urdf"
    narrow.write_text((folder / "arm.urdf").read_text().replace('upper="2"', 'upper="0"', 1))
    text = summary(calibrate_arm(narrow, folder / "measurements.csv"))
    assert re.search(r"swing was .*, beyond its limits in the URDF, -114.6 to 0.0\n", text)
    assert text.count("beyond its limits") == 1


def test_how_high_a_scara_stands_is_told_to_be_unknown(load, tmp_path):
    (tmp_path / "scara.urdf").write_text(SCARA)
    arm, random = load(SCARA), np.random.default_rng(4)
    joints = random.uniform([-1, 0.3, 0, -2], [1, 1.8, 0.3, 2], (30, 4))
    positions = arm.forward(joints + np.array([0.01, 0.02, 0.003, -0.02]))[:, :3, 3]
    columns = {f"{joint} [rad]": joints[:, index] for index, joint in enumerate(arm.joints)}
    columns["quill [m]"] = columns.pop("quill [rad]")
    write(tmp_path / "measured.csv", columns | in_millimetres(to_instrument(positions)))
    result = calibrate_arm(tmp_path / "scara.urdf", tmp_path / "measured.csv")
    line = "not identifiable from any posture: shift z of target or shift z of base; try: describe"
    assert f"{line} [target]\n" in summary(result)
    assert abs(result.places[1].pose[2, 3]) < 0.01


def test_a_distance_of_another_scale_is_doubted(in_sockets):
    text = summary(by_ball(DISTANCE.format("left", 270), in_sockets))
    assert "the distance between left and right is 11.1 percent larger than its descr" in text


def test_balls_in_sockets_of_the_wrong_names_are_refused(in_sockets):
    heading, *rows = in_sockets.read_text().splitlines()
    names = {"left": "right", "right": "left"}
    for number in range(1, len(rows), 4):
        (*joints, name) = rows[number].split(",")
        rows[number] = ",".join([*joints, names[name]])
    mixed = in_sockets.with_name("mixed.csv")
    mixed.write_text("\n".join([heading, *rows]))
    with pytest.raises(Untrustworthy, match="the link .* mm long by .*; .* other names of sockets"):
        by_ball("", mixed)


def test_centimetres_that_say_millimetres_are_refused(arm, folder):
    joints = postures(12)
    with pytest.raises(Untrustworthy, match="between lift and elbow is 40 mm long by .* 400 mm"):
        calibrated_by(arm, folder, joints, 0.1 * true_positions(arm, joints))


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        (INSTRUMENT, InvalidFile, "has an instrument; a ball in sockets needs none"),
        (DISTANCE.format("middle", 300), InvalidFile, "names socket 'middle'; the table has left"),
        (
            DISTANCE.format("left", 400),
            Mistaken,
            r"between left and right is 400 mm; in the URDF they are 29\d",
        ),
    ],
    ids=["instrument", "no socket", "another arm"],
)
def test_what_is_wrong_of_sockets_is_named(text, error, message, in_sockets):
    with pytest.raises(error, match=message):
        by_ball(text, in_sockets)


STAND = np.eye(4)  # in the arm's base
STAND[:3] = [[0, 1, 0, -0.5], [-1, 0, 0, 1.0], [0, 0, 1, 0.2]]


def calibrated(arm, folder, text: str, part: float = 1.0):
    """From rows in a part of the joints' ranges, with a description."""
    joints = postures(3, 40, part)
    (folder / "stand.toml").write_text(text)
    positions = to_instrument(measured(arm, joints))
    return calibrated_by(arm, folder, joints, positions, folder / "stand.toml")


def of_instrument(shift: float, turn: float, within: str = "") -> str:
    """A description with the instrument's pose, off by this along and about each axis [mm, deg]."""
    angles = Rotation.from_matrix(STAND[:3, :3]).as_euler("xyz", degrees=True) + turn
    millimetres = 1e3 * STAND[:3, 3] + shift
    lengths = [f"{number:.6f} mm{within and ' +- 3 mm'}" for number in millimetres]
    turns = [f"{angle:.6f} deg{within and ' +- 0.3 deg'}" for angle in angles]
    return f"[instrument]\nposition = {lengths}\nroll_pitch_yaw = {turns}\n"


def gap(result) -> float:
    """Distance [mm] of the identified instrument from where it is."""
    (place,) = [place for place in result.places if place.name == "the instrument"]
    return 1e3 * float(np.linalg.norm(place.pose[:3, 3] - STAND[:3, 3]))


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
