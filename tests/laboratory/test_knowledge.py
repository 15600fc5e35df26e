"""Knowledge that is wrong is named, and none is left unused without a word."""

import numpy as np
import pytest

from recalib.errors import InvalidFile
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.knowledge import WrongKnowledge
from recalib.laboratory.parameters import described
from tests.laboratory.test_calibrate import (
    DISTANCE,
    INSTRUMENT,
    ROWS,
    arm,
    folder,
    in_degrees,
    in_sockets,
    joints,
    measured,
    write,
)

__all__ = ["arm", "folder", "in_sockets", "joints"]
TURNED = INSTRUMENT.replace("[target]", 'roll_pitch_yaw = ["0 deg", "0 deg", "90 deg"]\n[target]')
ELSEWHERE = INSTRUMENT.replace('"50 mm"', '"450 mm"')
INVERTED = INSTRUMENT.replace('"1 m"', '"-1 m"')


@pytest.fixture(scope="module")
def table(arm, joints, folder):
    columns = in_degrees(arm, joints) | measured(arm, joints, np.full((ROWS, 3), [0, 0, 0.05]))
    write(folder / "knowledge.csv", columns)
    return folder / "knowledge.csv"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (TURNED, r"\[instrument\] is \d\d mm and 9\d deg from .* position = \[\"999 mm\", "),
        (INVERTED, r"\[instrument\] is 1999 mm and 1 deg from where the measurements put it"),
        (ELSEWHERE, r"\[target\] is 396 mm and 0 deg from where the measurements put it"),
        (TURNED[: TURNED.index("[target]")], r"\[instrument\] is \d\d mm and 9\d deg from"),
    ],
    ids=["turned", "inverted", "target", "instrument alone"],
)
def test_a_frame_that_is_not_there_is_named(text, said, table, folder):
    (folder / "wrong.toml").write_text(text)
    with pytest.raises(WrongKnowledge, match=rf"the description's {said}"):
        calibrate_arm(folder / "arm.urdf", table, folder / "wrong.toml")


def test_where_both_frames_are_wrong_it_is_said_that_they_are(table, folder):
    (folder / "both.toml").write_text(TURNED.replace('"50 mm"', '"450 mm"'))
    with pytest.raises(WrongKnowledge, match=r"\[instrument\] and \[target\] is .* and is "):
        calibrate_arm(folder / "arm.urdf", table, folder / "both.toml")


def test_a_distance_that_no_row_uses_is_refused(table, folder):
    (folder / "unused.toml").write_text(DISTANCE.format("left"))
    with pytest.raises(InvalidFile, match="a distance between sockets; .* no column 'socket'"):
        calibrate_arm(folder / "arm.urdf", table, folder / "unused.toml")


def test_a_distance_of_another_arm_is_refused_by_the_names_of_its_sockets(in_sockets, folder):
    (folder / "far.toml").write_text(DISTANCE.format("left").replace("300", "900"))
    said = r"distance between left and right is 900 mm; by the arm's description they are 29\d"
    with pytest.raises(WrongKnowledge, match=said):
        calibrate_arm("panda.urdf", in_sockets, folder / "far.toml", tool="panda_hand_tcp")


def test_sockets_keep_their_names(in_sockets, folder):
    (folder / "apart.toml").write_text(DISTANCE.format("left"))
    result = calibrate_arm("panda.urdf", in_sockets, folder / "apart.toml", tool="panda_hand_tcp")
    names = [each.name for each in described(result)]
    assert "x of socket left, beside its first guess" in names and "socket 1" not in str(names)
