"""Arrays in wrong shapes, units and numbers: each ends in our own exception, before any work."""

import contextlib
import os
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from recalib import EncoderShift, LinkShortening, RecalibError, apply, calibrate, load_correction
from tests.laboratory.conftest import postures

ROWS = 12
JOINTS = postures(1, ROWS)
POSES = np.tile(np.eye(4), (ROWS, 1, 1))
POSES[:, 0, 3] = 0.01 * np.arange(ROWS)


@pytest.mark.parametrize(
    ("joints", "measured", "options", "message"),
    [
        (JOINTS[0], POSES, {}, r"joints is 'of shape \(3,\)'; expected: .* of shape \(n, 3\)"),
        (JOINTS[:, :2], POSES, {}, r"joints is 'of shape \(12, 2\)'; expected: .* \(n, 3\)"),
        ("joints", POSES, {}, "joints is 'str'; expected: an array of finite numbers"),
        (JOINTS * np.nan, POSES, {}, "joints is 'an array with NaN or infinity'"),
        (JOINTS[:5], POSES[:5], {}, "it has 5 rows; expected: at least 10"),
        (np.degrees(JOINTS), POSES, {}, r"joints is 'up to 96.1 rad'; expected: up to 720 deg"),
        (JOINTS, 900 * POSES[:, :3, 0], {}, "measured is 'up to 900 m'; expected: up to 10 m"),
        (JOINTS * 0, POSES, {}, "no joint moves"),
        (JOINTS, POSES[:5], {}, r"measured is 'of shape \(5, 4, 4\)'; expected: .* \(12, 3\) or"),
        (JOINTS, 2 * POSES, {}, "measured is 'matrices that are not poses'; expected: poses"),
        (JOINTS, POSES.swapaxes(1, 2) + np.eye(4, k=-3), {}, "matrices that are not poses"),
        (
            JOINTS,
            0 * POSES[:, :3, 0],
            {},
            "11 of its rows, such as 2, repeat the previous measurement",
        ),
        (JOINTS, None, {}, "it has no measured columns; expected: x, y, z or socket"),
        (JOINTS, POSES, {"sockets": ["a"] * ROWS}, "it has both positions and sockets"),
        (np.ma.masked_greater(JOINTS, 0.5), POSES, {}, "joints is 'a masked array'"),
        (JOINTS, POSES, {"targets": [["a"], *"bcdefghijkl"]}, "expected: 12 names"),
        (JOINTS, POSES, {"targets": "abcdefghijkl"}, "expected: 12 names"),
        (JOINTS, POSES, {"targets": [None] * ROWS}, "row 1 of column 'target' is empty"),
        (JOINTS, POSES, {"targets": [np.nan] * ROWS}, "row 1 of column 'target' is empty"),
        (JOINTS, POSES, {"targets": ["a", "A"] * 6}, "differ only in capitals"),
        (JOINTS, POSES, {"targets": ["a"]}, r"targets is \['a'\]; expected: 12 names"),
        (JOINTS, POSES, {"times": np.arange(ROWS)[::-1]}, "row 2 was measured before row 1"),
        (JOINTS, POSES, {"instrument": np.zeros(3)}, r"instrument is 'of shape \(3,\)'"),
        (JOINTS, POSES, {"distances": {("a", "b"): 1}}, "has a distance between sockets"),
        (
            JOINTS,
            None,
            {"sockets": ["a", "b"] * 6, "distances": {("a", "c"): 1}},
            "names socket 'c'; the table has a, b",
        ),
    ],
)
def test_wrong_arrays_are_refused_with_what_was_expected(joints, measured, options, message, arm):
    with pytest.raises(RecalibError, match=message):
        calibrate(arm, joints, measured, **options)


SHAPES = arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=13)
ANY = st.one_of(
    st.none(),
    st.text(max_size=3),
    arrays.arrays(st.sampled_from([np.float64, np.int64, np.bool_, np.complex128, "U3"]), SHAPES),
    arrays.arrays(np.float64, st.sampled_from([(ROWS, 3), (ROWS, 4, 4), (11, 3), (4, 4)])),
)


@given(
    st.sampled_from(["ab", "", None, ("a",), ("a", "a"), ("a", "b", "c"), ("a", "c"), 3]),
    st.one_of(
        st.floats(max_value=0),
        st.sampled_from([np.nan, "412 mm", 412, [0.3], np.array([0.3]), None, True]),
    ),
)
def test_distances_that_are_none_are_refused_by_name(arm, pair, length):
    for distances in ({pair: 0.3}, {("a", "b"): length}, [("a", "b", 0.3)]):
        with pytest.raises(RecalibError, match="distance|names socket 'c'"):
            calibrate(arm, JOINTS, sockets=["a", "b"] * 6, distances=distances)


@settings(max_examples=100)
@given(ANY, ANY, st.sampled_from(["targets", "sockets", "times", "instrument", "target"]), ANY)
def test_whatever_is_given_ends_in_our_own_exception(arm, joints, measured, option, value):
    """Few of these arrays are of an arm; none of them ends in a traceback of NumPy's."""
    for given_joints, given_measured in ((joints, measured), (JOINTS, measured), (joints, POSES)):
        with np.errstate(all="ignore"), suppress(RecalibError):
            calibrate(arm, given_joints, given_measured, **{option: value})


@given(ANY)
@example(np.zeros((0, 3)))
def test_one_posture_or_many_and_no_other_shape(arm, joints):
    """Whatever is asked where the tool is says so, in the shape of the question, or refuses."""
    damaged = apply(arm, [LinkShortening("link_2", 0.01), EncoderShift("lift", 0.02)])
    for ask in (arm.forward, arm.gravity_torque, arm.skeleton, damaged.forward):
        with suppress(RecalibError):
            assert len(ask(joints)) == np.shape(joints)[0] or np.ndim(joints) == 1


NOT_A_FILE = st.one_of(
    st.sampled_from([None, 3, b"a.npz", "", ".", "..", "/", "a\0b", "a" * 300, "/dev/null"]),
    st.sampled_from(["folder", "file/a.npz", "/proc/a.npz"]),
)


@given(NOT_A_FILE, ANY)
def test_a_file_that_cannot_be_and_names_that_are_none_are_refused(calibrated, path, name):
    """A device, too: it would be replaced by a file."""
    correction = load_correction(calibrated)
    with TemporaryDirectory() as here, contextlib.chdir(here):
        Path("folder").mkdir()
        Path("file").touch()
        with pytest.raises(RecalibError):
            correction.save(path)
        assert sorted(os.listdir()) == ["file", "folder"]
    joints = correction.learned[:1]
    for key in ("target", "frame"):
        with suppress(RecalibError):
            correction.correct(correction.calibration.predict(joints)[:, :3, 3], **{key: name})


def test_one_posture_is_a_row_of_many(arm):
    poses, jacobians = arm.forward_and_jacobian(JOINTS)
    for many, one in (
        (poses, arm.forward(JOINTS[3].tolist())),
        (poses, arm.forward_and_jacobian(JOINTS[3])[0]),
        (jacobians, arm.forward_and_jacobian(JOINTS[3])[1]),
        (arm.skeleton(JOINTS), arm.skeleton(JOINTS[3])),
        (arm.gravity_torque(JOINTS), arm.gravity_torque(JOINTS[3])),
    ):
        assert np.array_equal(many[3], one)
