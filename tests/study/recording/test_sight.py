import numpy as np
import pytest

from recalib.study.recording.sight import HALF, sight_of


def test_a_place_in_the_picture_is_seen_there(robot):
    sight = sight_of(robot.workspace, np.array([[0.0, 0.0, 0.1]]))
    assert sight.seen(sight.place(0.3, -0.2)) == pytest.approx([0.3, -0.2])
    assert sight.seen(sight.target) == pytest.approx([0, 0], abs=1e-12)
    towards = sight.target - sight.eye
    for axis in sight.axes:  # in the plane that faces the eye, at half of the picture's height
        assert axis @ towards == pytest.approx(0, abs=1e-9)
        assert np.linalg.norm(axis) == pytest.approx(HALF * np.linalg.norm(towards))
